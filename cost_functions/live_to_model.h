#ifndef SPLITFUSION_COST_FUNCTIONS_LIVE_TO_MODEL_H_
#define SPLITFUSION_COST_FUNCTIONS_LIVE_TO_MODEL_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Pulls model points that are astray to live points without model, along the
/// line between the two: the distance to the plane through the live point that
/// faces the model point,
///
///   r = sqrt(c) d . (x - v_t),   d = (v_t - x_0) / |v_t - x_0|
///
/// x is the warped model point (Eq. 2), x_0 where it was at the association,
/// v_t the live point, c the confidence of its depth. Residual: 1, metres *
/// sqrt(confidence). Not in the paper, whose data term (Eq. 5) asks only where
/// the model is projected to: a limb that moved farther than its width is
/// projected beside itself.
///
/// The sum over all pairs of what the correspondences leave over is divided by
/// the sum of their confidences and of those of the correspondences: few pairs
/// weigh little. Its loss must not forget large residuals, as Tukey's does.
class LiveToModelTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.lost == nullptr) return;
    const WarpField warp(input.graph);
    std::vector<const ModelSample*> samples;
    std::vector<PointToPlane> functors;
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
