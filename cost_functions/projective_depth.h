#ifndef SPLITFUSION_COST_FUNCTIONS_PROJECTIVE_DEPTH_H_
#define SPLITFUSION_COST_FUNCTIONS_PROJECTIVE_DEPTH_H_

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Depth of one warped model point against the live depth where it is seen.
///
///   r = sqrt(c) [ x_3 - D(pi(x)) ],   D(pi(x)) = x_3 (n_t . v_t) / (n_t . x)
///
/// x is the warped model point (Eq. 2), D the live depth image, which is taken
/// for the plane through the live point v_t with the live normal n_t; c the
/// confidence of the depth. It measures along the view ray, as the sensor does;
/// Eq. 5 measures across the surface. Residual: 1, metres * sqrt(confidence).
/// Zero for any motion within the live tangent plane.
struct ProjectiveDepth {
  /// Residuals of one point.
  static constexpr int kResiduals = 1;  // Layout.
  Eigen::Vector3d normal;               ///< n_t, camera frame, unit length.
  double plane = 0;                     ///< n_t . v_t, metres.
  double sqrt_confidence = 1;           ///< sqrt(c).

  /// `x`: warped point, camera frame, metres; false where the view ray does not
  /// meet the live plane.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    const T along =
        T(normal.x()) * x[0] + T(normal.y()) * x[1] + T(normal.z()) * x[2];
    if (along == T(0)) return false;
    residual[0] = T(sqrt_confidence) * x[2] * (T(1) - T(plane) / along);
    return true;
  }
};

/// Depth differences over all correspondences.
class ProjectiveDepthTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    AddCorrespondenceResiduals(
        input.correspondences,
        [](const Correspondence& c) -> ProjectiveDepth {
          const Eigen::Vector3d normal = c.target_normal.cast<double>();
          return {normal, normal.dot(c.target.cast<double>()),
                  std::sqrt(c.weight)};
        },
        sink);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_PROJECTIVE_DEPTH_H_
