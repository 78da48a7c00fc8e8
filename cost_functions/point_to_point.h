#ifndef SPLITFUSION_COST_FUNCTIONS_POINT_TO_POINT_H_
#define SPLITFUSION_COST_FUNCTIONS_POINT_TO_POINT_H_

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Distance of one warped model point to its live point (Besl and McKay 1992).
///
///   r = sqrt(c) (x - v_t)
///
/// x is the warped model point (Eq. 2), v_t the live point, c the confidence of
/// the depth. Residual: 3, metres * sqrt(confidence). Unlike Eq. 5 it holds a
/// surface along itself, at the pixel where it was at the association.
struct PointToPoint {
  /// Residuals of one point.
  static constexpr int kResiduals = 3;  // Layout.
  Eigen::Vector3d target;               ///< v_t, camera frame, metres.
  double sqrt_confidence = 1;           ///< sqrt(c).

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(sqrt_confidence) * (x[d] - T(target[d]));
    }
    return true;
  }
};

/// Point-to-point distances over all correspondences.
class PointToPointTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    AddCorrespondenceResiduals(
        input.correspondences,
        [](const Correspondence& c) -> PointToPoint {
          return {c.target.cast<double>(), std::sqrt(c.weight)};
        },
        sink);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_POINT_TO_POINT_H_
