#ifndef SPLITFUSION_LIB_DEFORMATION_GRAPH_GROWTH_H_
#define SPLITFUSION_LIB_DEFORMATION_GRAPH_GROWTH_H_

#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_log.h"
#include "splitfusion/lib/deformation/node_change.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

class MeshSkinning;

/// How nodes are placed on a surface and tied together.
struct GraphOptions {
  int neighbors_per_point = 6;  ///< K of Eq. 3.
  int neighbors_per_node = 8;   ///< Edges of a node.
  /// Node spacing for surfaces near the camera and farther away, metres; in
  /// between linear in the depth at birth.
  double near_spacing = 0.025;
  /// Node spacing from `far_depth` on, metres.
  double far_spacing = 0.040;
  double near_depth = 0.7;  ///< Metres; up to here `near_spacing`.
  double far_depth = 1.5;   ///< Metres; from here `far_spacing`.
  int max_nodes = 2000;     ///< Per surface; the spacing grows to keep it.
  /// Nodes that come or go wait until they are so many, as a part of the
  /// graph's: every change renews edges and skinning. Meanwhile nodes a little
  /// farther away carry the points.
  double growth_batch = 0.005;
  /// What nodes carry that live depth refutes in so many frames on end is
  /// forgotten, see RefutedParts; 0: never, and it is fused as the rest.
  int refuted_frames = 3;
  /// A surface is torn where an edge of its mesh is longer than so many voxels,
  /// and nothing is seen before it (Surface::Tear()); 0: nowhere.
  double tear_voxels = 6;
  /// Refuted nodes wait until they are so many, as a part of the graph's;
  /// meanwhile they are carved as the rest.
  double refuted_share = 0.02;
  /// A node is confirmed once it was seen in so many frames; 0: at once, and
  /// for ever.
  int confirmed_frames = 10;
  /// What a node carries is forgotten, too, once the surface itself has hidden
  /// it in so many frames without a sight; of a confirmed one in as many times
  /// more as it was seen in more frames than that took, see UnconfirmedNodes.
  int unconfirmed_frames = 30;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// Node spacing for a surface at z-depth `depth`, both metres.
double NodeSpacing(const GraphOptions& options, double depth);

/// Adds nodes where the canonical mesh is farther than the node spacing from
/// every node, so that nodes cover the surface evenly (SplitFusion IV-B), and
/// ties all nodes along the surface. An empty graph is filled from scratch with
/// identity motions; see UpdateGraph() for one that has nodes: none is
/// forgotten.
///
/// @return number of nodes added.
int GrowGraph(const TriangleMesh& canonical_mesh, const GraphOptions& options,
              DeformationGraph* graph, MotionLog* history);

/// What a graph that follows its surface remembers beside its nodes.
struct GraphRecord {
  /// Node spacing of the surface, metres; that of the graph is wider where it
  /// was raised, see UpdateGraph().
  double planned_spacing = 0;
  /// Of every node whether it has carried a vertex; none beyond its end has.
  std::vector<char> carried;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(planned_spacing, carried);
  }
};

/// Makes a graph follow its surface, given the skinning by the graph as it is.
/// New nodes cover what they are missing on (as GrowGraph()); they get the
/// motion that the old ones blend to at their place, in the graph and in every
/// frame of `history` (may be null). Nodes that have carried vertices and carry
/// none any more are forgotten, in `history` too. When `max_nodes` would be
/// exceeded the spacing is raised, from the planned one, and the new nodes are
/// as many as fit; the graph keeps the widest.
///
/// @return what became of the nodes; edges are rebuilt if anything did, or with
///     `retie`.
NodeChange UpdateGraph(const TriangleMesh& canonical_mesh,
                       const GraphOptions& options, const SkinningIndex& index,
                       const MeshSkinning& skinning, DeformationGraph* graph,
                       GraphRecord* record, MotionLog* history,
                       bool retie = false);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_GRAPH_GROWTH_H_
