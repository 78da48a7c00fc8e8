#ifndef SPLITFUSION_LIB_DEFORMATION_SKINNING_H_
#define SPLITFUSION_LIB_DEFORMATION_SKINNING_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// Largest K of Eq. 3 that is supported.
constexpr int kMaxSkinningNodes = 8;

/// The nodes that carry one point, ascending by index, and their weights of
/// Eq. 3, which sum to 1.
struct Skinning {
  std::array<std::int32_t, kMaxSkinningNodes> nodes{};
  std::array<float, kMaxSkinningNodes> weights{};
  int count = 0;
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
/// A snapshot of the positions and edges of a graph; rebuild after growth.
class SkinningIndex {
 public:
  /// `neighbors_per_point` is K, 1..kMaxSkinningNodes.
  SkinningIndex(const DeformationGraph& graph, int neighbors_per_point);

  /// Skinning of a canonical point (metres). Thread-safe.
  Skinning Skin(const Eigen::Vector3f& point) const;

  /// Nearest node of a canonical point and its distance (metres).
  int NearestNode(const Eigen::Vector3f& point, float* distance) const;

 private:
  struct CellHash {
    std::size_t operator()(const Eigen::Vector3i& cell) const;
  };
  Eigen::Vector3i CellOf(const Eigen::Vector3f& point) const;

  int k_;
  float cell_size_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<std::vector<int>> candidates_;  // Per nearest node.
  std::unordered_map<Eigen::Vector3i, std::vector<int>, CellHash> cells_;
};

/// Node motions as affine maps p~ = A p + b in float, for warping many points.
class WarpField {
 public:
  explicit WarpField(const DeformationGraph& graph);

  /// Eq. 2: canonical point -> camera frame.
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

 private:
  struct Affine {
    Eigen::Matrix3f linear;
    Eigen::Vector3f offset;
  };
  std::vector<Affine> maps_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SKINNING_H_
