#include "splitfusion/lib/export/appearance.h"

#include <utility>

#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

using Triangles = std::vector<Eigen::Vector3i>;

/// Numbers things anew in the order in which they are asked for.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : place_(count, -1) {}

  /// The new number of `old`.
  int operator()(int old) {
    if (place_[old] < 0) {
      place_[old] = static_cast<int>(order_.size());
      order_.push_back(old);
    }
    return place_[old];
  }

  /// The same; -1 if it has none.
  int Find(int old) const { return place_[old]; }

  /// Old numbers, by new ones.
  const std::vector<int>& order() const { return order_; }

 private:
  std::vector<int> place_;
  std::vector<int> order_;
};

template <typename T>
std::vector<T> Picked(const std::vector<T>& from,
                      const std::vector<int>& which) {
  std::vector<T> picked;
  if (from.empty()) return picked;
  picked.reserve(which.size());
  for (const int i : which) picked.push_back(from[i]);
  return picked;
}

/// Nodes of a graph under new numbers, and the edges between them.
DeformationGraph PickedGraph(const DeformationGraph& graph,
                             const Renumbering& nodes) {
  DeformationGraph picked;
  picked.node_spacing = graph.node_spacing;
  picked.positions = Picked(graph.positions, nodes.order());
  picked.first_seen = Picked(graph.first_seen, nodes.order());
  picked.neighbors.resize(picked.positions.size());
  for (std::size_t i = 0; i < picked.neighbors.size(); ++i) {
    for (const int j : graph.neighbors[nodes.order()[i]]) {
      if (nodes.Find(j) >= 0) picked.neighbors[i].push_back(nodes.Find(j));
    }
  }
  return picked;
}

/// The piece of a surface that has `triangles`, from a moment on.
ExportSurface PieceOf(const ExportSurface& whole, Triangles triangles,
                      std::size_t first_moment) {
  ExportSurface piece;
  piece.id = whole.id;
  piece.label = whole.label;
  piece.name = whole.name;
  Renumbering vertices(whole.mesh.vertices.size());
  for (Eigen::Vector3i& triangle : triangles) {
    for (int k = 0; k < 3; ++k) triangle[k] = vertices(triangle[k]);
  }
  piece.mesh.vertices = Picked(whole.mesh.vertices, vertices.order());
  piece.mesh.normals = Picked(whole.mesh.normals, vertices.order());
  piece.mesh.colors = Picked(whole.mesh.colors, vertices.order());
  piece.mesh.triangles = std::move(triangles);
  piece.source = Picked(whole.source, vertices.order());
  piece.skinning = Picked(whole.skinning, vertices.order());
  Renumbering nodes(whole.graph.positions.size());
  for (Skinning& one : piece.skinning) {
    for (int k = 0; k < one.count; ++k) one.nodes[k] = nodes(one.nodes[k]);
  }
  piece.graph = PickedGraph(whole.graph, nodes);
  for (std::size_t m = first_moment; m < whole.moments.size(); ++m) {
    ExportMoment moment = whole.moments[m];
    moment.motions = Picked(moment.motions, nodes.order());
    piece.moments.push_back(std::move(moment));
  }
  return piece;
}

/// Those of the triangles that had been seen by a moment and did not appear
/// before; marks them in `shown`.
Triangles Appearing(const ExportSurface& surface, const ExportMoment& moment,
                    std::vector<char>* shown) {
  const Triangles& all = surface.mesh.triangles;
  Triangles appearing;
  std::size_t i = 0;
  for (const Eigen::Vector3i& triangle : SeenTriangles(
           surface.mesh, surface.skinning, surface.graph, moment.frame)) {
    while (all[i] != triangle) ++i;  // They are in order.
    if (!(*shown)[i]) appearing.push_back(triangle);
    (*shown)[i++] = 1;
  }
  return appearing;
}

}  // namespace

std::vector<ExportSurface> SplitByAppearance(const ExportSurface& surface,
                                             int step) {
  std::vector<char> shown(surface.mesh.triangles.size(), 0);
  std::vector<ExportSurface> pieces;
  int next = surface.moments.front().frame;
  for (std::size_t m = 0; m < surface.moments.size(); ++m) {
    const ExportMoment& moment = surface.moments[m];
    if (moment.frame < next && m + 1 < surface.moments.size()) continue;
    Triangles appearing = Appearing(surface, moment, &shown);
    if (m == 0 && appearing.size() == shown.size()) return {surface};
    if (appearing.empty() && pieces.empty()) continue;
    // At the multiples, as warped/ is.
    next = (moment.frame / step + 1) * step;
    if (appearing.empty()) continue;
    pieces.push_back(PieceOf(surface, std::move(appearing), m));
    if (pieces.size() > 1) {
      pieces.back().name += "_from_" + RunPaths::FrameName(moment.frame);
    }
  }
  if (!pieces.empty()) {
    pieces.front().stretched_triangles = surface.stretched_triangles;
  }
  return pieces;
}

}  // namespace splitfusion
