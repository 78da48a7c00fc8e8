#ifndef SPLITFUSION_LIB_DEFORMATION_DEFORMATION_GRAPH_H_
#define SPLITFUSION_LIB_DEFORMATION_DEFORMATION_GRAPH_H_

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Motion of one graph node (SplitFusion Eq. 1): p~ = R (p - g) + t + g maps a
/// canonical point p into the camera frame; metres.
struct NodeMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_i
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< t_i

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(rotation, translation);
  }
};

/// Nodes that are in use in some frames only, of a surface parts of which were
/// refuted or that was re-anchored.
struct ModelPart {
  /// Stands for the end of a part that is in use to the last frame.
  static constexpr int kNoEnd = std::numeric_limits<int>::max();

  int node = 0;            ///< Index of the first node; up to the next part's.
  int first_frame = 0;     ///< Index of the first frame.
  int end_frame = kNoEnd;  ///< Index of the frame behind the last one.
};

/// The embedded deformation graph of one surface (SplitFusion IV-B).
///
/// A rigid surface is the graph with one node at the canonical origin: its
/// motion is the rigid motion itself, its weight is 1 everywhere.
struct DeformationGraph {
  std::vector<Eigen::Vector3d> positions;  ///< g_i, canonical frame, metres.
  std::vector<NodeMotion> motions;         ///< Camera from canonical, per node.
  /// Edges: for every node the neighbours it is tied to, ascending. Directed;
  /// Eq. 6 sums over exactly these. Built along the surface, not across gaps.
  std::vector<std::vector<int>> neighbors;
  double node_spacing = 0;  ///< Metres; 0 for a rigid surface.
  /// First frame in which what each node carries was seen. Where it is not
  /// known of all of them, it is of none, and all counts as seen from the
  /// start.
  std::vector<int> first_seen;
  /// Parts that have no edge in common, ascending by their nodes. Empty: all
  /// nodes are in use in all frames.
  std::vector<ModelPart> parts;

  /// Number of nodes.
  int size() const { return static_cast<int>(positions.size()); }
  /// Whether one motion carries the whole surface.
  bool rigid() const { return positions.size() == 1; }

  /// Index of the node behind the last one of part k; of a graph without parts,
  /// which is one, behind all.
  int EndOfPart(std::size_t k) const {
    return k + 1 < parts.size() ? parts[k + 1].node : size();
  }
  /// Whether a node is in use in a frame.
  bool IsInUse(int node, int frame) const;

  /// Saves or restores it, see lib/base/archive.h; not `parts`, which only
  /// joined models have.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(positions, motions, neighbors, node_spacing, first_seen);
  }
};

/// The one-node graph of a rigid surface.
DeformationGraph MakeRigidGraph(const Rigid3d& camera_from_canonical);

/// Eq. 1: the point p (canonical) carried by node i alone; camera frame.
inline Eigen::Vector3d ApplyNode(const Eigen::Vector3d& g,
                                 const NodeMotion& motion,
                                 const Eigen::Vector3d& p) {
  return motion.rotation * (p - g) + motion.translation + g;
}

/// Moves the whole surface by one rigid motion of the camera frame (Q, s):
/// R_i <- Q R_i, t_i <- Q (g_i + t_i) + s - g_i.
void ApplyRigidMotion(const Rigid3d& motion, DeformationGraph* graph);

/// The single rigid motion that is closest to the nodes' motions (least squares
/// over the node positions); camera from canonical.
Rigid3d MeanRigidMotion(const DeformationGraph& graph);

/// Mean of the node positions, canonical frame, metres; the origin if there is
/// no node.
Eigen::Vector3d Center(const DeformationGraph& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_DEFORMATION_GRAPH_H_
