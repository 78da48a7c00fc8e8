#ifndef SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_
#define SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Difference of grey value between a warped model point and the live image.
///
///   r = m sqrt(c) [ I(pi(x)) - I_m ]
///     ~ m sqrt(c) [ d + grad I . (pi(x) - u_0) ],   d = I(u_0) - I_m
///
/// x is the warped model point (Eq. 2), pi the pinhole projection, u_0 its
/// pixel at the last association, about which the live image I is linear; I_m
/// the grey value of the model's colour, c the confidence of the depth, m what
/// a step from black to white counts for, metres: with 0.05 one of 0.2 counts
/// like one centimetre. It ties a surface along itself, where Eq. 5 lets it
/// slide; the paper has no such term, see docs/paper_map.md.
///
/// Residual: 1, metres * sqrt(confidence). Zero for motions along the view ray.
struct ColorConstancy {
  /// Residuals of one point.
  static constexpr int kResiduals = 1;  // Layout.
  Eigen::Vector2d focal;     ///< (fx, fy) of the live camera, pixels.
  Eigen::Vector2d offset;    ///< (cx, cy) - u_0, pixels.
  Eigen::Vector2d gradient;  ///< grad I at u_0, 1 / pixel.
  double difference = 0;     ///< d, 0..1.
  /// sqrt(c) of the confidence.
  double sqrt_confidence = 1;
  double metres = 0;  ///< m.

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    const T du = T(focal.x()) * x[0] / x[2] + T(offset.x());
    const T dv = T(focal.y()) * x[1] / x[2] + T(offset.y());
    residual[0] = T(metres * sqrt_confidence) *
                  (T(difference) + T(gradient.x()) * du + T(gradient.y()) * dv);
    return true;
  }
};

/// Colour constancy over all correspondences.
class ColorConstancyTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("metres", &metres_, Range::Above(0), "metres",
                 "That a difference from black to white counts for.");
  }

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const Eigen::Vector2d focal(input.camera.fx, input.camera.fy);
    const Eigen::Vector2d principal(input.camera.cx, input.camera.cy);
    AddCorrespondenceResiduals(
        input.correspondences,
        [&](const Correspondence& c) -> ColorConstancy {
          return {focal,
                  principal - c.pixel.cast<double>(),
                  c.intensity_gradient.cast<double>(),
                  c.intensity_difference,
                  std::sqrt(c.weight),
                  metres_};
        },
        sink);
  }

 private:
  double metres_ = 0.05;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_
