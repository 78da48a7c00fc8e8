#include "splitfusion/lib/deformation/graph_growth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/deformation/node_births.h"
#include "splitfusion/lib/deformation/surface_edges.h"

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

/// Vertices that keep `spacing` from the nodes and from one another, greedily
/// in vertex order. Specks of the mesh (vertices without a triangle) get none.
std::vector<int> UncoveredVertices(const TriangleMesh& mesh,
                                   const std::vector<SkinningSupport>& supports,
                                   double spacing) {
  std::vector<char> open(mesh.vertices.size(), false);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) open[t[k]] = true;
  }
  CoverGrid cover(spacing);
  std::vector<int> uncovered;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!open[i] || (!supports.empty() && supports[i].distance < spacing)) {
      continue;
    }
    const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
    if (cover.Covers(p)) continue;
    cover.Insert(p);
    uncovered.push_back(static_cast<int>(i));
  }
  return uncovered;
}

/// The nodes but those that carried a vertex once and carry none now,
/// ascending: what was fused in a wrong place and refuted since leaves nodes
/// behind. Notes which nodes have carried one: those of what was seen too
/// seldom to be meshed have not yet.
std::vector<int> NodesToKeep(const std::vector<Skinning>& skinning, int nodes,
                             std::vector<char>* carried) {
  std::vector<char> carries(nodes, false);
  for (const Skinning& s : skinning) {
    for (int k = 0; k < s.count; ++k) carries[s.nodes[k]] = true;
  }
  carried->resize(nodes, false);
  std::vector<int> kept;
  for (int i = 0; i < nodes; ++i) {
    if (carries[i] || !(*carried)[i]) kept.push_back(i);
    (*carried)[i] |= carries[i];
  }
  return kept;
}

/// Vertices for new nodes, as many as there is room for; the spacing is raised
/// where it would be exceeded.
struct NewNodes {
  std::vector<int> vertices;
  double spacing = 0;  // Metres.
};

NewNodes FindNewNodes(const TriangleMesh& mesh, const GraphOptions& options,
                      const std::vector<SkinningSupport>& supports, int nodes,
                      double spacing) {
  const int room = options.max_nodes - nodes;
  NewNodes found{{}, spacing};
  if (nodes > 0 && room <= 0) return found;
  found.vertices = UncoveredVertices(mesh, supports, found.spacing);
  while (static_cast<int>(found.vertices.size()) > room) {
    constexpr double kWider = 1.1;
    found.spacing *= kWider;
    found.vertices = UncoveredVertices(mesh, supports, found.spacing);
  }
  return found;
}

/// For every node the vertex nearest to it of those that have no nearer node;
/// the new nodes are vertices.
std::vector<NodeSeed> FindSeeds(const std::vector<SkinningSupport>& supports,
                                int old_nodes, const std::vector<int>& added) {
  std::vector<NodeSeed> seeds(old_nodes);
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const float distance = supports[i].distance;
    NodeSeed& seed = seeds[supports[i].nearest];
    if (seed.vertex < 0 || distance < seed.distance) {
      seed = {static_cast<int>(i), distance};
    }
  }
  for (const int vertex : added) seeds.push_back({vertex, 0});
  return seeds;
}

/// Takes nodes in that stand at vertices of the mesh, leaves those out that are
/// not kept, and ties all nodes anew.
void ReplaceNodes(const TriangleMesh& mesh, const GraphOptions& options,
                  const std::vector<SkinningSupport>& supports,
                  const NewNodes& added, const NodeChange& change,
                  DeformationGraph* graph) {
  std::vector<NodeSeed> seeds =
      FindSeeds(supports, graph->size(), added.vertices);
  graph->node_spacing = std::max(graph->node_spacing, added.spacing);
  for (const int vertex : added.vertices) {
    graph->positions.push_back(mesh.vertices[vertex].cast<double>());
  }
  change.Apply(&seeds);
  change.Apply(&graph->positions);
  change.Apply(&graph->motions);
  change.Apply(&graph->first_seen);
  graph->neighbors = ConnectAlongSurface(graph->positions, seeds, mesh,
                                         options.neighbors_per_node);
}

}  // namespace

void GraphOptions::List(OptionList* list) {
  list->Number("neighbors_per_point", &neighbors_per_point,
               {1, kMaxSkinningNodes}, "nodes",
               "K, the number of nodes that move a point (Eq. 3).")
      .common = true;
  list->Number("neighbors_per_node", &neighbors_per_node, {1, 64}, "nodes",
               "Edges from each node.");
  list->Number("near_spacing", &near_spacing, Range::AtLeast(0.002), "metres",
               "Node spacing of surfaces up to near_depth.");
  list->Number("far_spacing", &far_spacing, Range::AtLeast(0.002), "metres",
               "Node spacing of surfaces from far_depth on; at least "
               "near_spacing.");
  list->Demand(far_spacing >= near_spacing, "far_spacing",
               "metres >= near_spacing");
  list->Number("near_depth", &near_depth, Range::Above(0), "metres",
               "Depth up to which near_spacing applies.");
  list->Number("far_depth", &far_depth, Range::Above(0), "metres",
               "Depth from which far_spacing applies; more than near_depth.");
  list->Demand(far_depth > near_depth, "far_depth", "metres > near_depth");
  list->Number("max_nodes", &max_nodes, Range::AtLeast(1), "nodes",
               "Nodes of a graph at most; its spacing grows to keep to that.");
  list->Number(
      "growth_batch", &growth_batch, Range::Share(), "",
      "Nodes that come or go wait until they are this share of the graph's "
      "(fewer, larger changes are faster).");
  list->Number("refuted_frames", &refuted_frames, Range::AtLeast(0), "frames",
               "A part of a deforming surface that hangs in free space in so "
               "many frames on end is forgotten; 0 = never.");
  list->Number("tear_voxels", &tear_voxels, Range::AtLeast(0), "voxels",
               "A deforming surface is torn where an edge of its mesh is "
               "longer and nothing is seen before it; 0 = nowhere.");
  list->Number("refuted_share", &refuted_share, Range::Share(), "",
               "Such parts wait until they are this share of the nodes.");
  list->Number("confirmed_frames", &confirmed_frames, Range::AtLeast(0),
               "frames",
               "A node of a deforming surface is confirmed once it was seen in "
               "so many frames; 0: at once, and for ever.");
  list->Number("unconfirmed_frames", &unconfirmed_frames, Range::AtLeast(1),
               "frames",
               "A node is forgotten once the surface itself has hidden it in "
               "so many frames without a sight; one that was seen in n times "
               "the frames that confirm it, in n times as many.");
}

void GraphOptions::Check() const { CheckOptions(*this); }

double NodeSpacing(const GraphOptions& options, double depth) {
  const double t = std::clamp(
      (depth - options.near_depth) / (options.far_depth - options.near_depth),
      0.0, 1.0);
  return options.near_spacing +
         t * (options.far_spacing - options.near_spacing);
}

int GrowGraph(const TriangleMesh& canonical_mesh, const GraphOptions& options,
              DeformationGraph* graph, MotionLog* history) {
  if (graph->size() > 0) {
    const SkinningIndex index(*graph, options.neighbors_per_point);
    const MeshSkinning skinning(index, canonical_mesh.vertices);
    GraphRecord record{graph->node_spacing, {}};
    return UpdateGraph(canonical_mesh, options, index, skinning, graph, &record,
                       history)
        .added;
  }
  const NewNodes added =
      FindNewNodes(canonical_mesh, options, {}, 0, graph->node_spacing);
  graph->motions.resize(added.vertices.size());
  NodeChange change;
  change.added = static_cast<int>(added.vertices.size());
  ReplaceNodes(canonical_mesh, options, {}, added, change, graph);
  return graph->size();
}

NodeChange UpdateGraph(const TriangleMesh& canonical_mesh,
                       const GraphOptions& options, const SkinningIndex& index,
                       const MeshSkinning& skinning, DeformationGraph* graph,
                       GraphRecord* record, MotionLog* history, bool retie) {
  const NodeChange none = NodeChange::None(graph->size());
  if (skinning.skinning().empty()) return none;
  NodeChange change{
      graph->size(),
      NodesToKeep(skinning.skinning(), graph->size(), &record->carried)};
  double batch = options.growth_batch * graph->size();
  const int room = options.max_nodes - graph->size();
  if (!retie && room <= 0 && (change.none() || change.forgotten() < batch)) {
    return none;
  }
  // The last nodes that there is room for do not wait.
  if (change.forgotten() == 0) batch = std::min<double>(batch, room);
  const NewNodes added = FindNewNodes(
      canonical_mesh, options, skinning.supports(),
      static_cast<int>(change.kept.size()), record->planned_spacing);
  change.added = static_cast<int>(added.vertices.size());
  if (!retie && (change.none() || change.added + change.forgotten() < batch)) {
    return none;
  }
  std::vector<Eigen::Vector3f> places;
  for (const int vertex : added.vertices) {
    places.push_back(canonical_mesh.vertices[vertex]);
  }
  const NodeBirths births(*graph, index, std::move(places));
  births.Append(&graph->motions);
  if (history != nullptr) history->Grow(births, change);
  ReplaceNodes(canonical_mesh, options, skinning.supports(), added, change,
               graph);
  change.Apply(&record->carried);
  return change;
}

}  // namespace splitfusion
