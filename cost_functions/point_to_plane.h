#ifndef SPLITFUSION_COST_FUNCTIONS_POINT_TO_PLANE_H_
#define SPLITFUSION_COST_FUNCTIONS_POINT_TO_PLANE_H_

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Point-to-plane distance of one warped model point to its live point.
///
///   r = sqrt(c) n_m . (x - v_t)                              SplitFusion Eq. 5
///
/// x is the warped model point (Eq. 2, a blend over K nodes), v_t the live
/// point, n_m the model normal rotated by the warp at the last association and
/// held constant while differentiating, c the confidence of the depth. With
/// x(twists) from WarpFunctor: dr/dtau_i = sqrt(c) w_i n_m and, at zero twist,
/// dr/domega_i = sqrt(c) w_i (R_i (v - g_i)) x n_m.
///
/// Residual: 1, metres * sqrt(confidence). Zero for any motion within the
/// tangent plane; unchanged if camera frame, point and plane move together.
struct PointToPlane {
  /// Residuals of one point.
  static constexpr int kResiduals = 1;  // Layout.
  Eigen::Vector3d normal;               ///< n_m, camera frame, unit length.
  Eigen::Vector3d target;               ///< v_t, camera frame, metres.
  /// sqrt(c) of the confidence.
  double sqrt_confidence = 1;

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = T(sqrt_confidence) * (T(normal.x()) * (x[0] - T(target.x())) +
                                        T(normal.y()) * (x[1] - T(target.y())) +
                                        T(normal.z()) * (x[2] - T(target.z())));
    return true;
  }
};

/// E_data of Eq. 5 over all correspondences.
class PointToPlaneTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    AddCorrespondenceResiduals(
        input.correspondences,
        [](const Correspondence& c) -> PointToPlane {
          return {c.warped_normal.cast<double>(), c.target.cast<double>(),
                  std::sqrt(c.weight)};
        },
        sink);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_POINT_TO_PLANE_H_
