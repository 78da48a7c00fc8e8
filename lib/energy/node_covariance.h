#ifndef SPLITFUSION_LIB_ENERGY_NODE_COVARIANCE_H_
#define SPLITFUSION_LIB_ENERGY_NODE_COVARIANCE_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "splitfusion/lib/energy/selected_inverse.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// How well a solved problem holds the motions of a surface's nodes, and so its
/// points: their covariance by the Gauss-Newton (Laplace) approximation about
/// the solution,
///
///   C = sigma_0^2 (J^T J)^-1,   sigma_0^2 = 2 E / (m - p),
///
/// J of all m scalar residuals, with weights, normalisation and losses of
/// Eq. 4, by the twists [omega (rad), tau (m)] of the nodes (p numbers), E the
/// energy. The terms of Eq. 4 are means, so that J^T J has no unit of
/// likelihood: sigma_0^2, the a posteriori variance of unit weight, gives it
/// one. What is assumed:
///
/// - The weights of the terms are right relative to one another. Those of the
///   prior count as measurements: a part that no data touch is as uncertain as
///   the prior lets it be, not as certain as its estimate is repeatable.
/// - Residuals are independent. Those of neighbouring pixels are not (depth
///   noise, wrong pairs, the model's own errors), so that C is too small by a
///   factor that is to be fitted (docs/evaluation.md).
/// - The pairs are right. Where they are not, the surface lies elsewhere, and
///   C cannot know.
/// - Unknowns of the terms' own are known at their estimates: they are few, and
///   all residuals of their term hold them.
/// - One solve, one frame: what has slid along the surface since it was first
///   seen is no part of it.
///
/// A direction that is known to no better than 1 m or 1 rad counts as known to
/// that: a part that nothing holds makes nothing singular.
class NodeCovariance {
 public:
  /// @param problem as it was minimised last.
  /// @param graph its solution; must outlive this.
  /// @param points skinnings of the points that OfPoint() will be asked for.
  NodeCovariance(const SurfaceProblem& problem, const DeformationGraph& graph,
                 const std::vector<Skinning>& points);

  /// Covariance of the twists of two nodes of which one residual or one of
  /// `points` depends; by [omega (rad), tau (m)] of `i` and of `j`.
  Block6 Block(int i, int j) const { return inverse_->Block(i, j); }

  /// Covariance of a warped point (Eq. 2), camera frame, square metres: J_v C
  /// J_v^T with the correlations between the nodes that carry it,
  /// J_v = w_k [-[R_k (v - g_k)]x | 1]. `point` is canonical, metres,
  /// `skinning` one of `points`.
  Eigen::Matrix3d OfPoint(const Skinning& skinning,
                          const Eigen::Vector3f& point) const;

  /// sigma_0^2
  double unit_variance() const { return unit_variance_; }
  /// Nodes that no residual over points depends on, ascending: they are held
  /// by the prior alone.
  const std::vector<int>& held_by_prior() const { return held_by_prior_; }

 private:
  const DeformationGraph& graph_;
  double unit_variance_ = 0;
  std::vector<int> held_by_prior_;
  std::optional<SelectedInverse> inverse_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_NODE_COVARIANCE_H_
