#ifndef SPLITFUSION_LIB_DEFORMATION_SKINNING_H_
#define SPLITFUSION_LIB_DEFORMATION_SKINNING_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {

/// Largest K of Eq. 3 that is supported.
constexpr int kMaxSkinningNodes = 8;  // Layout.

/// The nodes that carry one point, ascending by index, and their weights of
/// Eq. 3, which sum to 1.
struct Skinning {
  std::array<std::int32_t, kMaxSkinningNodes> nodes{};  ///< Node indices.
  std::array<float, kMaxSkinningNodes> weights{};       ///< w_ij, sum 1.
  int count = 0;                                        ///< Nodes used.
};

/// What the skinning of a point depends on.
struct SkinningSupport {
  int nearest = -1;    ///< The nearest node; -1 = not known.
  float distance = 0;  ///< Of the point from it, metres.
  /// Nodes farther than this from the nearest one do not matter, metres.
  float reach = 0;
};

/// Finds the skinning of points (SplitFusion Eq. 3): the K nearest nodes,
/// w = (1 - |v - g_i| / d_max)^2 normalised, d_max = distance to the (K+1)-th.
/// With fewer than K+1 nodes all are used with d_max = twice the distance to
/// the farthest; a single node has weight 1.
///
/// Candidates are the nodes within two edges of the nearest node, so that a
/// point on an arm is not carried by the torso that it touches: edges follow
/// the surface.
///
/// A snapshot of the positions and edges of a graph; rebuild after a change.
class SkinningIndex {
 public:
  /// `neighbors_per_point` is K, 1..kMaxSkinningNodes; the graph has a node.
  SkinningIndex(const DeformationGraph& graph, int neighbors_per_point);

  /// Skinning of a canonical point (metres). Thread-safe.
  Skinning Skin(const Eigen::Vector3f& point) const;

  /// The same, faster after a point nearby: `support` is that point's (or not
  /// known) and becomes this one's.
  Skinning Skin(const Eigen::Vector3f& point, SkinningSupport* support) const;

  /// Skinning of many canonical points, in parallel.
  std::vector<Skinning> Skin(const std::vector<Eigen::Vector3f>& points) const;

  /// Nearest node of a canonical point; `distance` (metres) may be null.
  int NearestNode(const Eigen::Vector3f& point, float* distance) const {
    return tree_.Find(point, -1, distance);
  }

  /// Number of nodes.
  int node_count() const { return node_count_; }

  /// How far the nodes are, metres, that may carry the points nearest to `node`
  /// by one of two indices of the same graph but not by the other; infinity if
  /// there is no difference, 0 if the node itself is gone. `numbers`: index
  /// after of every node before, -1 = gone.
  static float FirstDifference(const SkinningIndex& before,
                               const SkinningIndex& after,
                               const std::vector<int>& numbers, int node);

 private:
  /// The nodes that may carry the points nearest to one node, by their distance
  /// from it.
  struct CandidateList {
    std::vector<int> nodes;
    std::vector<float> x, y, z;   // Their positions.
    std::vector<float> distance;  // From the one node, metres.
  };

  int k_;
  int node_count_;
  NearestPoint tree_;
  std::vector<CandidateList> candidates_;  // By nearest node.
};

/// Node motions as affine maps p~ = A p + b in float, for warping many points.
class WarpField {
 public:
  /// Takes a snapshot of the graph's motions.
  explicit WarpField(const DeformationGraph& graph);

  /// Eq. 2: canonical point -> camera frame, metres.
  Eigen::Vector3f WarpPoint(const Skinning& skinning,
                            const Eigen::Vector3f& point) const {
    Eigen::Vector3f warped = Eigen::Vector3f::Zero();
    for (int k = 0; k < skinning.count; ++k) {
      const Affine& map = maps_[skinning.nodes[k]];
      warped += skinning.weights[k] * (map.linear * point + map.offset);
    }
    return warped;
  }

  /// Canonical unit normal -> camera frame: the blended rotation, normalised.
  Eigen::Vector3f WarpNormal(const Skinning& skinning,
                             const Eigen::Vector3f& normal) const {
    Eigen::Vector3f warped = Eigen::Vector3f::Zero();
    for (int k = 0; k < skinning.count; ++k) {
      warped +=
          skinning.weights[k] * (maps_[skinning.nodes[k]].linear * normal);
    }
    return warped.normalized();
  }

  /// Camera frame unit normal -> canonical, the inverse of WarpNormal.
  Eigen::Vector3f UnwarpNormal(const Skinning& skinning,
                               const Eigen::Vector3f& normal) const {
    Eigen::Vector3f unwarped = Eigen::Vector3f::Zero();
    for (int k = 0; k < skinning.count; ++k) {
      unwarped += skinning.weights[k] *
                  (maps_[skinning.nodes[k]].linear.transpose() * normal);
    }
    return unwarped.normalized();
  }

  /// The blended motion of a point as a node would have it if it stood there
  /// (`point` canonical): its Eq. 1 agrees with Eq. 2 at the point.
  NodeMotion BlendMotion(const Skinning& skinning,
                         const Eigen::Vector3f& point) const;

 private:
  struct Affine {
    Eigen::Matrix3f linear;
    Eigen::Vector3f offset;
  };
  std::vector<Affine> maps_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SKINNING_H_
