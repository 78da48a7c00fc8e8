#ifndef SPLITFUSION_COST_FUNCTIONS_SYMMETRIC_H_
#define SPLITFUSION_COST_FUNCTIONS_SYMMETRIC_H_

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Symmetric distances (Rusinkiewicz 2019) over all correspondences:
///
///   r = sqrt(c) (n_m + n_t) / 2 . (x - v_t)
///
/// Eq. 5 with the mean of the normals of the warped model point and the live
/// point, both held constant while differentiating. It is zero where the two
/// lie on a common circle: on a curved surface a pair that is off along it
/// pulls less than by Eq. 5. Residual: 1, metres * sqrt(confidence).
class SymmetricTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    AddCorrespondenceResiduals(
        input.correspondences,
        [](const Correspondence& c) -> PointToPlane {
          const Eigen::Vector3f mean =
              0.5f * (c.warped_normal + c.target_normal);
          return {mean.cast<double>(), c.target.cast<double>(),
                  std::sqrt(c.weight)};
        },
        sink);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_SYMMETRIC_H_
