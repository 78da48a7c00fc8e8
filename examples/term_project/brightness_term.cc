// A shared library with one energy term that estimates numbers beside the
// motions:
//   sf_run --terms_library=libbrightness.so --set="terms.brightness.weight=1"

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <vector>

#include "splitfusion/lib/energy/correspondence_residuals.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/terms_library.h"

namespace {

/// Metres that a step from black to white counts for.
constexpr double kMetres = 0.05;

/// Grey value of the live image at a warped model point x, against the model's
/// times a gain g, plus an offset b, which all points of the surface share:
///
///   r = m sqrt(c) [ I(pi(x)) - g I_m - b ]
///   I(pi(x)) = I_0 + grad I . (pi(x) - u)
///
/// The association has taken the median difference of the grey values out of
/// I_0. Without b, which puts it back, g would stay at 1 whatever the exposure.
/// Residual: 1, metres * sqrt(confidence).
struct Brightness {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 2;
  Eigen::Vector2d focal;     ///< (fx, fy), pixels.
  Eigen::Vector2d from;      ///< (cx, cy) - u, pixels.
  Eigen::Vector2d gradient;  ///< grad I, 1 / pixel.
  double live;               ///< I_0, 0..1.
  double model;              ///< I_m, 0..1.
  double scale;              ///< m sqrt(c), metres.

  /// `x`: warped point, camera frame, metres; `unknowns`: g and b.
  template <typename T>
  bool operator()(const T* x, const T* unknowns, T* residual) const {
    T grey = T(live) - unknowns[0] * T(model) - unknowns[1];
    for (int d = 0; d < 2; ++d) {
      grey += T(gradient[d]) * (T(focal[d]) * x[d] / x[2] + T(from[d]));
    }
    residual[0] = T(scale) * grey;
    return true;
  }
};

/// Prior: two more points of confidence 1, one that sees the gain as 1 and one
/// that sees the offset as 0.
struct Prior {
  static constexpr int kResiduals = 2;
  static constexpr int kUnknowns = 2;

  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = T(kMetres) * (unknowns[0] - T(1));
    residual[1] = T(kMetres) * unknowns[1];
    return true;
  }
};

class BrightnessTerm : public splitfusion::EnergyTerm {
 public:
  std::vector<splitfusion::Unknown> Unknowns() const override {
    // They are the camera's: other surfaces begin where the background, which
    // is tracked first, has left them.
    const auto start = splitfusion::UnknownStart::kBackground;
    return {{"gain", /*unit=*/"", /*initial=*/1, /*scale=*/1, start},
            {"offset", /*unit=*/"", /*initial=*/0, /*scale=*/1, start}};
  }

  void AddResiduals(const splitfusion::EnergyInput& input,
                    splitfusion::ResidualSink* sink) const override {
    const splitfusion::PinholeCamera& camera = input.camera;
    splitfusion::AddCorrespondenceResiduals(
        input.correspondences,
        [&](const splitfusion::Correspondence& c) -> Brightness {
          return {{camera.fx, camera.fy},
                  {camera.cx - c.pixel.x(), camera.cy - c.pixel.y()},
                  c.intensity_gradient.cast<double>(),
                  c.model_intensity + c.intensity_difference,
                  c.model_intensity,
                  kMetres * std::sqrt(c.weight)};
        },
        sink);
    sink->AddUnknowns(std::vector<Prior>(1));
  }
};

void AddTerms(splitfusion::TermRegistry* terms) {
  terms->Register("brightness",
                  [] { return std::make_unique<BrightnessTerm>(); });
}

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
