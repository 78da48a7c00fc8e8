#ifndef SPLITFUSION_COST_FUNCTIONS_LIVE_TO_MODEL_H_
#define SPLITFUSION_COST_FUNCTIONS_LIVE_TO_MODEL_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Distance of a model point that is astray from a live point without model,
/// along the line between the two.
///
///   r = sqrt(c) d . (x - v_t),   d = (v_t - x_0) / |v_t - x_0|
///
/// x is the warped model point (Eq. 2), x_0 where it was at the association,
/// v_t the live point, c the confidence of its depth. Not in the paper, whose
/// data term (Eq. 5) asks only where the model is projected to: a limb that
/// moved farther than its width is projected beside itself.
///
/// Residual: 1, metres * sqrt(confidence).
struct LiveToModel {
  /// Residuals of one point.
  static constexpr int kResiduals = 1;  // Layout.
  Eigen::Vector3d direction;            ///< d, camera frame.
  Eigen::Vector3d target;               ///< v_t, camera frame, metres.
  double sqrt_confidence = 1;           ///< sqrt(c)

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] =
        T(sqrt_confidence) * (T(direction.x()) * (x[0] - T(target.x())) +
                              T(direction.y()) * (x[1] - T(target.y())) +
                              T(direction.z()) * (x[2] - T(target.z())));
    return true;
  }
};

/// Over all pairs of what the correspondences leave over, divided by the sum of
/// their confidences and of those of the correspondences: few pairs weigh
/// little. Its loss must
/// not forget large residuals, as Tukey's does.
class LiveToModelTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.lost == nullptr) return;
    const WarpField warp(input.graph);
    std::vector<const ModelSample*> samples;
    std::vector<LiveToModel> functors;
    double total = 0;
    for (const Correspondence& c : input.correspondences) total += c.weight;
    for (const Correspondence& c : *input.lost) {
      const Eigen::Vector3f way =
          c.target - warp.WarpPoint(c.model.skinning, c.model.point);
      samples.push_back(&c.model);
      functors.push_back({way.normalized().cast<double>(),
                          c.target.cast<double>(), std::sqrt(c.weight)});
      total += c.weight;
    }
    sink->AddWarpedPoints(samples, functors, total);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_LIVE_TO_MODEL_H_
