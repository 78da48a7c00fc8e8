// A shared library with one energy term that estimates a number beside the
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
/// times a gain g that all points of the surface share:
///
///   r = m sqrt(c) [ I(pi(x)) - g I_m ],   I(pi(x)) = I_0 + grad I . (pi(x) -
///   u)
///
/// Residual: 1, metres * sqrt(confidence).
struct Brightness {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;
  Eigen::Vector2d focal;     ///< (fx, fy), pixels.
  Eigen::Vector2d from;      ///< (cx, cy) - u, pixels.
  Eigen::Vector2d gradient;  ///< grad I, 1 / pixel.
  double live;               ///< I_0, 0..1.
  double model;              ///< I_m, 0..1.
  double scale;              ///< m sqrt(c), metres.

  /// `x`: warped point, camera frame, metres; `unknowns`: g.
  template <typename T>
  bool operator()(const T* x, const T* unknowns, T* residual) const {
    T grey = T(live) - unknowns[0] * T(model);
    for (int d = 0; d < 2; ++d) {
      grey += T(gradient[d]) * (T(focal[d]) * x[d] / x[2] + T(from[d]));
    }
    residual[0] = T(scale) * grey;
    return true;
  }
};

/// Prior of the gain: one more point of confidence 1 that sees it as 1.
struct GainPrior {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;

  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = T(kMetres) * (unknowns[0] - T(1));
    return true;
  }
};

class BrightnessTerm : public splitfusion::EnergyTerm {
 public:
  std::vector<splitfusion::Unknown> Unknowns() const override {
    return {{"gain", /*unit=*/"", /*initial=*/1}};
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
    sink->AddUnknowns(std::vector<GainPrior>(1));
  }
};

void AddTerms(splitfusion::TermRegistry* terms) {
  terms->Register("brightness",
                  [] { return std::make_unique<BrightnessTerm>(); });
}

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
