#include "splitfusion/lib/visibility/known_triangles.h"

#include <algorithm>
#include <iterator>

#include "splitfusion/lib/visibility/known_nodes.h"

namespace splitfusion {
namespace {

/// Whether the node nearest to a point (the one with the greatest weight of
/// Eq. 3), or another one no farther than the node spacing, is known. Such a
/// point had a node near enough, and the graph did not grow over it.
bool IsKnown(const Eigen::Vector3f& point, const Skinning& skinning,
             const DeformationGraph& graph,
             const std::vector<char>& known_nodes) {
  const auto begin = skinning.weights.begin();
  const auto nearest = std::max_element(begin, begin + skinning.count) - begin;
  for (int k = 0; k < skinning.count; ++k) {
    const int node = skinning.nodes[k];
    if (!known_nodes[node]) continue;
    const double distance =
        (graph.positions[node] - point.cast<double>()).norm();
    if (k == nearest || distance < graph.node_spacing) return true;
  }
  return false;
}

std::vector<Eigen::Vector3i> TrianglesNear(
    const std::vector<char>& known_nodes, const TriangleMesh& mesh,
    const std::vector<Skinning>& skinning, const DeformationGraph& graph) {
  if (std::all_of(known_nodes.begin(), known_nodes.end(),
                  [](char known) { return known; })) {
    return mesh.triangles;
  }
  std::vector<char> known(mesh.vertices.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    known[i] = IsKnown(mesh.vertices[i], skinning[i], graph, known_nodes);
  }
  std::vector<Eigen::Vector3i> triangles;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(),
               std::back_inserter(triangles), [&](const Eigen::Vector3i& t) {
                 return known[t[0]] && known[t[1]] && known[t[2]];
               });
  return triangles;
}

}  // namespace

std::vector<Eigen::Vector3i> KnownTriangles(
    const TriangleMesh& mesh, const std::vector<Skinning>& skinning,
    const DeformationGraph& graph, int frame) {
  return TrianglesNear(KnownNodes(graph, frame), mesh, skinning, graph);
}

std::vector<Eigen::Vector3i> SeenTriangles(
    const TriangleMesh& mesh, const std::vector<Skinning>& skinning,
    const DeformationGraph& graph, int frame) {
  return TrianglesNear(SeenNodes(graph, frame), mesh, skinning, graph);
}

}  // namespace splitfusion
