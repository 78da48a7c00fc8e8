#include "splitfusion/lib/deformation/graph_growth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/deformation/surface_edges.h"
#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

/// Positions in cubes of one spacing, to ask whether a point is covered.
class CoverGrid {
 public:
  explicit CoverGrid(double spacing) : spacing_(spacing) {}

  void Insert(const Eigen::Vector3d& p) { cells_[Cell(p)].push_back(p); }

  bool Covers(const Eigen::Vector3d& p) const {
    const auto [x, y, z] = Cell(p);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find({x + dx, y + dy, z + dz});
          if (cell == cells_.end()) continue;
          for (const Eigen::Vector3d& q : cell->second) {
            if ((p - q).squaredNorm() < spacing_ * spacing_) return true;
          }
        }
      }
    }
    return false;
  }

 private:
  using Key = std::tuple<int, int, int>;
  Key Cell(const Eigen::Vector3d& p) const {
    return {static_cast<int>(std::floor(p.x() / spacing_)),
            static_cast<int>(std::floor(p.y() / spacing_)),
            static_cast<int>(std::floor(p.z() / spacing_))};
  }
  double spacing_;
  std::map<Key, std::vector<Eigen::Vector3d>> cells_;
};

/// Clears the flag of every vertex that a node of the graph covers.
void CloseNear(const TriangleMesh& mesh, const DeformationGraph& graph,
               double spacing, std::vector<char>* open) {
  std::vector<Eigen::Vector3f> nodes;
  for (const Eigen::Vector3d& g : graph.positions) {
    nodes.push_back(g.cast<float>());
  }
  const NearestPoint tree(nodes);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, open->size(), 2048),
      [&](const tbb::blocked_range<std::size_t>& range) {
        int nearest = -1;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          float distance = 0;
          nearest = tree.Find(mesh.vertices[i], nearest, &distance);
          if (distance < spacing) (*open)[i] = false;
        }
      });
}

/// Vertices that keep `spacing` from the nodes and from one another, greedily
/// in vertex order. Specks of the mesh (vertices without a triangle) get none.
std::vector<Eigen::Vector3d> UncoveredPositions(const TriangleMesh& mesh,
                                                const DeformationGraph& graph,
                                                double spacing) {
  std::vector<char> open(mesh.vertices.size(), false);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) open[t[k]] = true;
  }
  if (graph.size() > 0) CloseNear(mesh, graph, spacing, &open);
  CoverGrid cover(spacing);
  std::vector<Eigen::Vector3d> added;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
    if (!open[i] || cover.Covers(p)) continue;
    cover.Insert(p);
    added.push_back(p);
  }
  return added;
}

/// The nodes that carry some new ones, as a graph of their own.
struct Carriers {
  DeformationGraph graph;  // Without edges.
  std::vector<int> nodes;  // Their indices in the whole graph.
  std::vector<Skinning>
      skinning;  // Of the new nodes, by the carriers' indices.
};

Carriers FindCarriers(const DeformationGraph& graph, const SkinningIndex& index,
                      const std::vector<Eigen::Vector3d>& added) {
  Carriers carriers;
  std::map<int, int> number;
  for (const Eigen::Vector3d& g : added) {
    Skinning skinning = index.Skin(g.cast<float>());
    for (int k = 0; k < skinning.count; ++k) {
      const int node = skinning.nodes[k];
      const auto [entry, is_new] =
          number.emplace(node, static_cast<int>(carriers.nodes.size()));
      if (is_new) {
        carriers.nodes.push_back(node);
        carriers.graph.positions.push_back(graph.positions[node]);
      }
      skinning.nodes[k] = entry->second;
    }
    carriers.skinning.push_back(skinning);
  }
  carriers.graph.motions.resize(carriers.nodes.size());
  return carriers;
}

/// Appends the motions of new nodes, blended from those of their carriers.
void BlendNewMotions(const std::vector<Eigen::Vector3d>& added,
                     Carriers* carriers, std::vector<NodeMotion>* motions) {
  for (std::size_t i = 0; i < carriers->nodes.size(); ++i) {
    carriers->graph.motions[i] = (*motions)[carriers->nodes[i]];
  }
  const WarpField warp(carriers->graph);
  for (std::size_t i = 0; i < added.size(); ++i) {
    motions->push_back(
        warp.BlendMotion(carriers->skinning[i], added[i].cast<float>()));
  }
}

/// Positions for new nodes, as many as there is room for; the spacing is raised
/// where it would be exceeded.
std::vector<Eigen::Vector3d> NewPositions(const TriangleMesh& mesh,
                                          const GraphOptions& options,
                                          DeformationGraph* graph) {
  std::vector<Eigen::Vector3d> added =
      UncoveredPositions(mesh, *graph, graph->node_spacing);
  const int room = options.max_nodes - graph->size();
  while (static_cast<int>(added.size()) > room) {
    graph->node_spacing *= 1.1;
    added = UncoveredPositions(mesh, *graph, graph->node_spacing);
    if (graph->size() > 0 && room <= 0) added.clear();
  }
  return added;
}

}  // namespace

void GraphOptions::Check() const {
  CheckOption(
      neighbors_per_point >= 1 && neighbors_per_point <= kMaxSkinningNodes,
      "neighbors_per_point", neighbors_per_point,
      "1.." + std::to_string(kMaxSkinningNodes));
  CheckOption(neighbors_per_node >= 1 && neighbors_per_node <= 64,
              "neighbors_per_node", neighbors_per_node, "1..64");
  CheckOption(near_spacing >= 0.002, "near_spacing", near_spacing,
              "metres >= 0.002");
  CheckOption(far_spacing >= near_spacing, "far_spacing", far_spacing,
              "metres >= near_spacing");
  CheckOption(near_depth > 0, "near_depth", near_depth, "metres > 0");
  CheckOption(far_depth > near_depth, "far_depth", far_depth,
              "metres > near_depth");
  CheckOption(max_nodes >= 1, "max_nodes", max_nodes, ">= 1");
  CheckOption(growth_batch >= 0 && growth_batch <= 1, "growth_batch",
              growth_batch, "0..1");
}

double NodeSpacing(const GraphOptions& options, double depth) {
  const double t = std::clamp(
      (depth - options.near_depth) / (options.far_depth - options.near_depth),
      0.0, 1.0);
  return options.near_spacing +
         t * (options.far_spacing - options.near_spacing);
}

int GrowGraph(const TriangleMesh& canonical_mesh, const GraphOptions& options,
              DeformationGraph* graph, MotionHistory* history) {
  if (graph->size() > 0) {
    return GrowGraph(canonical_mesh, options,
                     SkinningIndex(*graph, options.neighbors_per_point), graph,
                     history);
  }
  const std::vector<Eigen::Vector3d> nodes =
      NewPositions(canonical_mesh, options, graph);
  graph->positions = nodes;
  graph->motions.resize(nodes.size());
  graph->neighbors = ConnectAlongSurface(graph->positions, canonical_mesh,
                                         options.neighbors_per_node);
  return graph->size();
}

int GrowGraph(const TriangleMesh& canonical_mesh, const GraphOptions& options,
              const SkinningIndex& index, DeformationGraph* graph,
              MotionHistory* history) {
  const std::vector<Eigen::Vector3d> added =
      NewPositions(canonical_mesh, options, graph);
  const auto count = static_cast<double>(added.size());
  if (added.empty() || count < options.growth_batch * graph->size()) return 0;
  Carriers carriers = FindCarriers(*graph, index, added);
  BlendNewMotions(added, &carriers, &graph->motions);
  if (history != nullptr) {
    for (FrameMotions& frame : history->frames) {
      BlendNewMotions(added, &carriers, &frame.motions);
    }
  }
  graph->positions.insert(graph->positions.end(), added.begin(), added.end());
  graph->neighbors = ConnectAlongSurface(graph->positions, canonical_mesh,
                                         options.neighbors_per_node);
  return static_cast<int>(added.size());
}

}  // namespace splitfusion
