#include "splitfusion/lib/visibility/seen_triangles.h"

#include <algorithm>
#include <iterator>

namespace splitfusion {
namespace {

/// Whether a node near a point had been seen: the nearest one (with the
/// greatest weight of Eq. 3), or another no farther than the node spacing. Such
/// a point had a node near enough, and the graph did not grow over it. `known`:
/// whether it is recorded when nodes were seen first; else all were.
bool IsSeen(const Eigen::Vector3f& point, const Skinning& skinning,
            const DeformationGraph& graph, bool known, int frame) {
  const auto begin = skinning.weights.begin();
  const auto nearest = std::max_element(begin, begin + skinning.count) - begin;
  for (int k = 0; k < skinning.count; ++k) {
    const int node = skinning.nodes[k];
    const double distance =
        (graph.positions[node] - point.cast<double>()).norm();
    if (k != nearest && distance >= graph.node_spacing) continue;
    if (graph.IsInUse(node, frame) &&
        (!known || graph.first_seen[node] <= frame)) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Eigen::Vector3i> SeenTriangles(
    const TriangleMesh& mesh, const std::vector<Skinning>& skinning,
    const DeformationGraph& graph, int frame) {
  const std::vector<int>& first = graph.first_seen;
  const bool known = static_cast<int>(first.size()) == graph.size();
  if (graph.parts.empty() &&
      (!known || *std::max_element(first.begin(), first.end()) <= frame)) {
    return mesh.triangles;
  }
  std::vector<char> seen(mesh.vertices.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen[i] = IsSeen(mesh.vertices[i], skinning[i], graph, known, frame);
  }
  std::vector<Eigen::Vector3i> triangles;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(),
               std::back_inserter(triangles), [&](const Eigen::Vector3i& t) {
                 return seen[t[0]] && seen[t[1]] && seen[t[2]];
               });
  return triangles;
}

}  // namespace splitfusion
