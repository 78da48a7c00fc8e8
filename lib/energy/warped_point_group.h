#ifndef SPLITFUSION_LIB_ENERGY_WARPED_POINT_GROUP_H_
#define SPLITFUSION_LIB_ENERGY_WARPED_POINT_GROUP_H_

#include <ceres/cost_function.h>
#include <ceres/jet.h>
#include <ceres/loss_function.h>
#include <ceres/rotation.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/warp_functor.h"

namespace splitfusion {

/// Residuals of all points that are carried by the same nodes, as one block.
///
/// Per point the value is that of WarpFunctor<PointFunctor>. Differentiation is
/// automatic but in parts, joined by the chain rule: Jet<3> over the warped
/// point for r(x), Jet<3> over omega for each node's exp(omega), once for the
/// whole group. That costs about a fifth of one wide Jet per point.
///
/// Ceres applies a loss to a whole block, so the loss of the single points is
/// applied here, exactly as Ceres' corrector does for losses with rho'' <= 0:
/// residual and Jacobian are scaled by sqrt(rho'(s)), s = |r|^2. One more
/// residual, sqrt(sum of rho(s) - rho'(s) s) >= 0, has a zero Jacobian and
/// makes the squared norm of the block the sum of rho(s): cost, gradient and
/// Gauss-Newton matrix all equal those of one Ceres block a point.
template <typename PointFunctor>
class WarpedPointGroup : public ceres::CostFunction {
 public:
  /// Residuals of one point.
  static constexpr int kDims = PointFunctor::kResiduals;

  /// `nodes`: the common node set. `residual_scale` multiplies residuals before
  /// the loss, `weight_root` after it.
  WarpedPointGroup(const DeformationGraph& graph, std::vector<int> nodes,
                   double residual_scale, double weight_root,
                   std::shared_ptr<const ceres::LossFunction> loss)
      : nodes_(std::move(nodes)),
        residual_scale_(residual_scale),
        weight_root_(weight_root),
        loss_(std::move(loss)) {
    for (const int node : nodes_) {
      centers_.push_back(graph.motions[node].translation +
                         graph.positions[node]);
      mutable_parameter_block_sizes()->push_back(kTwistSize);
    }
    set_num_residuals(1);
  }

  /// Adds a canonical point whose skinning has exactly the group's nodes.
  void Add(const DeformationGraph& graph, const Skinning& skinning,
           const Eigen::Vector3f& point, PointFunctor functor) {
    for (int k = 0; k < skinning.count; ++k) {
      const NodeTransport transport = MakeTransport(
          graph, skinning.nodes[k], skinning.weights[k], point.cast<double>());
      rotated_.push_back(transport.rotated);
      weights_.push_back(transport.weight);
    }
    functors_.push_back(std::move(functor));
    set_num_residuals(kDims * size() + 1);
  }

  /// Number of points.
  int size() const { return static_cast<int>(functors_.size()); }
  /// Nodes of the parameter blocks, in order.
  const std::vector<int>& nodes() const { return nodes_; }

  /// Ceres' interface: kDims rows a point, and the one that holds the rest.
  bool Evaluate(double const* const* twists, double* residuals,
                double** jacobians) const override {
    std::array<NodeRotation, kMaxSkinningNodes> rotations;
    const int nodes = static_cast<int>(nodes_.size());
    for (int k = 0; k < nodes; ++k) rotations[k] = Rotation(twists[k]);
    double rest = 0;
    for (int i = 0; i < size(); ++i) {
      if (!EvaluatePoint(i, twists, rotations, residuals + kDims * i, jacobians,
                         &rest)) {
        return false;
      }
    }
    residuals[kDims * size()] = weight_root_ * std::sqrt(std::max(rest, 0.0));
    for (int k = 0; jacobians != nullptr && k < nodes; ++k) {
      if (jacobians[k] == nullptr) continue;
      std::fill_n(jacobians[k] + kDims * size() * kTwistSize, kTwistSize, 0.0);
    }
    return true;
  }

 private:
  using Jet3 = ceres::Jet<double, 3>;
  using JacobianBlock =
      Eigen::Map<Eigen::Matrix<double, kDims, kTwistSize, Eigen::RowMajor>>;

  /// exp(omega) and its derivative by the three components of omega.
  struct NodeRotation {
    Eigen::Matrix3d value;
    std::array<Eigen::Matrix3d, 3> derivative;
  };

  static NodeRotation Rotation(const double* omega) {
    const Jet3 jets[3] = {{omega[0], 0}, {omega[1], 1}, {omega[2], 2}};
    Jet3 matrix[9];
    ceres::AngleAxisToRotationMatrix(jets, matrix);  // Column-major.
    NodeRotation rotation;
    for (int e = 0; e < 9; ++e) {
      rotation.value.data()[e] = matrix[e].a;
      for (int d = 0; d < 3; ++d) {
        rotation.derivative[d].data()[e] = matrix[e].v[d];
      }
    }
    return rotation;
  }

  bool EvaluatePoint(
      int i, double const* const* twists,
      const std::array<NodeRotation, kMaxSkinningNodes>& rotation,
      double* residual, double** jacobians, double* rest) const {
    const int nodes = static_cast<int>(nodes_.size());
    const Eigen::Vector3d* rotated = &rotated_[i * nodes];
    const double* weights = &weights_[i * nodes];
    Eigen::Vector3d warped = Eigen::Vector3d::Zero();
    for (int k = 0; k < nodes; ++k) {
      warped += weights[k] * (rotation[k].value * rotated[k] + centers_[k] +
                              Eigen::Map<const Eigen::Vector3d>(twists[k] + 3));
    }
    const Jet3 point[3] = {{warped[0], 0}, {warped[1], 1}, {warped[2], 2}};
    Jet3 value[kDims];
    if (!functors_[i](point, value)) return false;
    double squared_norm = 0;
    for (int d = 0; d < kDims; ++d) {
      residual[d] = residual_scale_ * value[d].a;
      squared_norm += residual[d] * residual[d];
    }
    double rho[3];
    loss_->Evaluate(squared_norm, rho);
    *rest += rho[0] - rho[1] * squared_norm;
    const double scale = weight_root_ * std::sqrt(rho[1]);
    for (int d = 0; d < kDims; ++d) residual[d] *= scale;
    if (jacobians == nullptr) return true;
    Eigen::Matrix<double, kDims, 3> by_point;
    for (int d = 0; d < kDims; ++d) {
      by_point.row(d) = scale * residual_scale_ * value[d].v.transpose();
    }
    for (int k = 0; k < nodes; ++k) {
      if (jacobians[k] == nullptr) continue;
      Eigen::Matrix3d by_omega;
      for (int d = 0; d < 3; ++d) {
        by_omega.col(d) = rotation[k].derivative[d] * rotated[k];
      }
      JacobianBlock block(jacobians[k] + kDims * kTwistSize * i);
      const Eigen::Matrix<double, kDims, 3> weighted = weights[k] * by_point;
      block.template leftCols<3>() = weighted * by_omega;
      block.template rightCols<3>() = weighted;
    }
    return true;
  }

  std::vector<int> nodes_;
  std::vector<Eigen::Vector3d> centers_;
  double residual_scale_;
  double weight_root_;
  std::shared_ptr<const ceres::LossFunction> loss_;
  std::vector<PointFunctor> functors_;
  std::vector<Eigen::Vector3d> rotated_;  // size() x nodes
  std::vector<double> weights_;           // size() x nodes
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_WARPED_POINT_GROUP_H_
