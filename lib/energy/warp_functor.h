#ifndef SPLITFUSION_LIB_ENERGY_WARP_FUNCTOR_H_
#define SPLITFUSION_LIB_ENERGY_WARP_FUNCTOR_H_

#include <ceres/rotation.h>

#include <Eigen/Core>
#include <utility>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/energy/twist.h"

namespace splitfusion {

/// A node's motion under an increment, without the increment:
/// exp(omega) q + c + tau with q = R (v - g), c = t + g.
struct NodeTransport {
  Eigen::Vector3d rotated;  ///< q: R_i (v - g_i), metres.
  Eigen::Vector3d center;   ///< c: t_i + g_i, camera frame, metres.
  double weight = 0;        ///< w_ij of Eq. 3.
};

/// Transport of the canonical point `point` by node `node` of the graph.
inline NodeTransport MakeTransport(const DeformationGraph& graph, int node,
                                   double weight,
                                   const Eigen::Vector3d& point) {
  const NodeMotion& motion = graph.motions[node];
  const Eigen::Vector3d& g = graph.positions[node];
  return {motion.rotation * (point - g), motion.translation + g, weight};
}

/// A residual of a warped point, as a function of the twists of all the nodes
/// that carry it:
///
///   r(x) with x = sum_i w_i [ exp(omega_i) R_i (v - g_i) + g_i + t_i + tau_i ]
///
/// which is SplitFusion Eq. 2 after the increments R_i <- exp(omega_i) R_i and
/// t_i <- t_i + tau_i. `PointFunctor` is r: a template functor of the warped
/// point, (const T* x, T* residual), with a constant kResiduals.
///
/// This is the plain form, for ceres::DynamicAutoDiffCostFunction; the solvers
/// use WarpedPoints and PointResiduals, which differentiate the same in parts.
template <typename PointFunctor>
class WarpFunctor {
 public:
  /// The first `count` transports belong to the twists in order.
  WarpFunctor(const DeformationGraph& graph, const Skinning& skinning,
              const Eigen::Vector3f& point, PointFunctor functor)
      : count_(skinning.count), functor_(std::move(functor)) {
    for (int k = 0; k < count_; ++k) {
      transports_[k] = MakeTransport(graph, skinning.nodes[k],
                                     skinning.weights[k], point.cast<double>());
    }
  }

  /// `twists[k]` is the twist of the k-th node of the skinning.
  template <typename T>
  bool operator()(T const* const* twists, T* residuals) const {
    T warped[3] = {T(0), T(0), T(0)};
    for (int k = 0; k < count_; ++k) {
      const NodeTransport& node = transports_[k];
      const T rotated[3] = {T(node.rotated.x()), T(node.rotated.y()),
                            T(node.rotated.z())};
      T moved[3];
      ceres::AngleAxisRotatePoint(twists[k], rotated, moved);
      for (int d = 0; d < 3; ++d) {
        warped[d] +=
            T(node.weight) * (moved[d] + T(node.center[d]) + twists[k][3 + d]);
      }
    }
    return functor_(warped, residuals);
  }

 private:
  std::array<NodeTransport, kMaxSkinningNodes> transports_;
  int count_;
  PointFunctor functor_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_WARP_FUNCTOR_H_
