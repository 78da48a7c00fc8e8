#include "splitfusion/lib/deformation/seen_triangles.h"

#include <algorithm>
#include <iterator>

namespace splitfusion {
namespace {

/// Whether the node nearest to a point (the one with the greatest weight of
/// Eq. 3), or another one no farther than the node spacing, had been seen. Such
/// a point had a node near enough, and the graph did not grow over it.
bool WasSeen(const Eigen::Vector3f& point, const Skinning& skinning,
             const DeformationGraph& graph, int frame) {
  const auto begin = skinning.weights.begin();
  const auto nearest = std::max_element(begin, begin + skinning.count) - begin;
  for (int k = 0; k < skinning.count; ++k) {
    const int node = skinning.nodes[k];
    if (graph.first_seen[node] > frame) continue;
    const double distance =
        (graph.positions[node] - point.cast<double>()).norm();
    if (k == nearest || distance < graph.node_spacing) return true;
  }
  return false;
}

}  // namespace

std::vector<Eigen::Vector3i> SeenTriangles(
    const TriangleMesh& mesh, const std::vector<Skinning>& skinning,
    const DeformationGraph& graph, int frame) {
  const bool all_seen =
      graph.first_seen.size() < graph.positions.size() ||
      std::all_of(graph.first_seen.begin(), graph.first_seen.end(),
                  [frame](int first) { return first <= frame; });
  if (all_seen) return mesh.triangles;
  std::vector<char> was_seen(mesh.vertices.size());
  for (std::size_t i = 0; i < was_seen.size(); ++i) {
    was_seen[i] = WasSeen(mesh.vertices[i], skinning[i], graph, frame);
  }
  std::vector<Eigen::Vector3i> seen;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(),
               std::back_inserter(seen), [&](const Eigen::Vector3i& t) {
                 return was_seen[t[0]] && was_seen[t[1]] && was_seen[t[2]];
               });
  return seen;
}

}  // namespace splitfusion
