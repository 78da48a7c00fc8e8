#ifndef SPLITFUSION_COST_FUNCTIONS_RELATIVE_POSE_H_
#define SPLITFUSION_COST_FUNCTIONS_RELATIVE_POSE_H_

#include <ceres/rotation.h>

#include <Eigen/Core>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/typical_points.h"

namespace splitfusion {

/// An edge of a pose graph (Lu and Milios 1997): how far two poses are from a
/// measured motion between them, where the scene is.
///
///   r_k = 1/2 (T_j T_i^-1 p_k - M p_k),  T <- X T,  X y = exp(omega) y + tau
///
/// T_i and T_j take points of the world to frames i and j, M is the measured
/// motion from frame i to frame j, and p_1 to p_4 are points of frame i that
/// stand for what it shows (TypicalPoints): turns and shifts weigh what they
/// move there, metres, and |r|^2 is the mean square over the four.
/// Residual: 12, metres. Unknown: the twists [omega, tau] of i and of j.
class RelativePose {
 public:
  /// Residuals of an edge.
  static constexpr int kResiduals = 12;  // Layout.

  /// `before`: T_j T_i^-1 at twists of zero; `measured`: M. Metres.
  RelativePose(const Rigid3d& before, const Rigid3d& measured,
               const TypicalPoints& points)
      : before_(before), points_(points), targets_(measured * points) {}

  /// `from`, `to`: twists of i and j.
  template <typename T>
  bool operator()(const T* from, const T* to, T* residuals) const {
    const T back[3] = {-from[0], -from[1], -from[2]};
    for (int k = 0; k < points_.cols(); ++k) {
      T shifted[3], in_from[3], in_to[3];
      for (int d = 0; d < 3; ++d) shifted[d] = points_(d, k) - from[3 + d];
      ceres::AngleAxisRotatePoint(back, shifted, in_from);
      const Eigen::Matrix<T, 3, 1> moved =
          before_.linear().cast<T>() *
              Eigen::Map<const Eigen::Matrix<T, 3, 1>>(in_from) +
          before_.translation().cast<T>();
      ceres::AngleAxisRotatePoint(to, moved.data(), in_to);
      for (int d = 0; d < 3; ++d) {
        residuals[3 * k + d] = 0.5 * (in_to[d] + to[3 + d] - targets_(d, k));
      }
    }
    return true;
  }

 private:
  Rigid3d before_;
  TypicalPoints points_, targets_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_RELATIVE_POSE_H_
