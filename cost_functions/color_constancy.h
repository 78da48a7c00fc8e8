#ifndef SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_
#define SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

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
    const T du = focal.x() * x[0] / x[2] + offset.x();
    const T dv = focal.y() * x[1] / x[2] + offset.y();
    residual[0] = metres * sqrt_confidence *
                  (difference + gradient.x() * du + gradient.y() * dv);
    return true;
  }
};

/// The same where the live image may be brighter or darker than the model, and
/// of more or less contrast, by a gain g and an offset b that are estimated:
///
///   r = m sqrt(c) [ I(pi(x)) - g I_m - b ]
///
/// The gain is on the model's side: its grey values are means of many frames,
/// while noise of the live ones would draw their factor to 0, and with it all
/// that the residual says of the motion.
struct ExposedColorConstancy {
  /// Residuals of one point.
  static constexpr int kResiduals = 1;  // Layout.
  /// g and b.
  static constexpr int kUnknowns = 2;  // Layout.
  ColorConstancy color;                ///< With g = 1, b = 0.
  double model_intensity = 0;          ///< I_m, 0..1.

  /// `x`: warped point, camera frame, metres; `unknowns`: g, b.
  template <typename T>
  bool operator()(const T* x, const T* unknowns, T* residual) const {
    if (!color(x, residual)) return false;
    residual[0] -= color.metres * color.sqrt_confidence *
                   ((unknowns[0] - 1.0) * model_intensity + unknowns[1]);
    return true;
  }
};

/// Prior of these, r = sqrt(p) m [ g - 1, b ]: it weighs as much as p more
/// points of confidence 1. With p = 1 it decides only what the points leave
/// open, as those of a surface of one colour, which do not tell g from b.
struct ExposurePrior {
  /// Residuals.
  static constexpr int kResiduals = 2;  // Layout.
  /// g and b.
  static constexpr int kUnknowns = 2;  // Layout.
  double metres = 0;                   ///< sqrt(p) m.

  /// `unknowns`: g, b.
  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = T(metres) * (unknowns[0] - T(1));
    residual[1] = T(metres) * unknowns[1];
    return true;
  }
};

/// Colour constancy over all correspondences.
class ColorConstancyTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("metres", &metres_, Range::Above(0), "metres",
                 "That a difference from black to white counts for.");
    list->Switch("exposure", &exposure_,
                 "Gain and offset of the brightness are estimated with the "
                 "motion, of each surface and frame.");
    list->Number("exposure_prior", &exposure_prior_, Range::AtLeast(0),
                 "points",
                 "Points of confidence 1 that hold the gain at 1 and the "
                 "offset at 0.");
  }

  std::vector<Unknown> Unknowns() const override {
    if (!exposure_) return {};
    return {{"gain", "", 1}, {"offset", "grey value", 0}};
  }

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const Eigen::Vector2d focal(input.camera.fx, input.camera.fy);
    const Eigen::Vector2d principal(input.camera.cx, input.camera.cy);
    const auto color = [&](const Correspondence& c) -> ColorConstancy {
      return {focal,
              principal - c.pixel.cast<double>(),
              c.intensity_gradient.cast<double>(),
              c.intensity_difference,
              std::sqrt(c.weight),
              metres_};
    };
    if (!exposure_) {
      AddCorrespondenceResiduals(input.correspondences, color, sink);
      return;
    }
    AddCorrespondenceResiduals(
        input.correspondences,
        [&](const Correspondence& c) -> ExposedColorConstancy {
          return {color(c), c.model_intensity};
        },
        sink);
    sink->AddUnknowns(
        std::vector<ExposurePrior>{{metres_ * std::sqrt(exposure_prior_)}});
  }

 private:
  double metres_ = 0.05;
  bool exposure_ = false;
  double exposure_prior_ = 1;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_COLOR_CONSTANCY_H_
