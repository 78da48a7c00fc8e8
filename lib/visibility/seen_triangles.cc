#include "splitfusion/lib/visibility/seen_triangles.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace splitfusion {
namespace {

/// Calls something for the node nearest to a point (the one with the greatest
/// weight of Eq. 3), and for others no farther than the node spacing. Such a
/// point had a node near enough, and the graph did not grow over it.
template <typename Visit>
void ForEachNear(const Eigen::Vector3f& point, const Skinning& skinning,
                 const DeformationGraph& graph, const Visit& visit) {
  const auto begin = skinning.weights.begin();
  const auto nearest = std::max_element(begin, begin + skinning.count) - begin;
  for (int k = 0; k < skinning.count; ++k) {
    const int node = skinning.nodes[k];
    const double distance =
        (graph.positions[node] - point.cast<double>()).norm();
    if (k == nearest || distance < graph.node_spacing) visit(node);
  }
}

/// Whether a node near a point had been seen. `known`: whether it is recorded
/// when nodes were seen first; else all were.
bool IsSeen(const Eigen::Vector3f& point, const Skinning& skinning,
            const DeformationGraph& graph, bool known, int frame) {
  bool seen = false;
  ForEachNear(point, skinning, graph, [&](int node) {
    seen = seen || (graph.IsInUse(node, frame) &&
                    (!known || graph.first_seen[node] <= frame));
  });
  return seen;
}

}  // namespace

int FirstSight(const Eigen::Vector3f& point, const Skinning& skinning,
               const DeformationGraph& graph) {
  int first = std::numeric_limits<int>::max();
  ForEachNear(point, skinning, graph, [&](int node) {
    if (node < static_cast<int>(graph.first_seen.size())) {
      first = std::min(first, graph.first_seen[node]);
    }
  });
  return first;
}

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
