#ifndef SPLITFUSION_COST_FUNCTIONS_TRACKS_H_
#define SPLITFUSION_COST_FUNCTIONS_TRACKS_H_

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Distance of a warped model point, across the view, from where its point
/// track is seen:
///
///   r = sqrt(c) ( z_t [ pi(x) - pi(v_t) ], sqrt(d) [ x_3 - z_t ] )
///
/// x is the warped model point (Eq. 2), pi(x) = (x_1, x_2) / x_3, v_t the live
/// point where the track is seen, z_t its depth and c the confidence of that.
/// Eq. 5 asks for the depth where the model is projected to, this for that
/// where the point is seen: a limb that moves off along the view by more than
/// the gates of Eq. 5, or beside itself, still has its own depth. d is the key
/// `depth` times how much better than the depth a pixel is known:
///
///   sqrt(d) = sqrt(depth) min(1, (z_t / f) / sigma(z_t))
///
/// f the focal length, sigma the noise of the depth: a pixel for the one, a
/// standard deviation for the other.
///
/// Residuals: 3, metres * sqrt(confidence).
struct TrackDistance {
  /// Residuals of one point.
  static constexpr int kResiduals = 3;  // Layout.
  Eigen::Vector3d target;               ///< v_t, camera frame, metres.
  double sqrt_confidence = 1;           ///< sqrt(c).
  double along = 1;                     ///< sqrt(d).

  /// `x`: warped point, camera frame, metres.
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    const T scale = T(sqrt_confidence * target.z());
    residual[0] = scale * (x[0] / x[2] - T(target.x() / target.z()));
    residual[1] = scale * (x[1] / x[2] - T(target.y() / target.z()));
    residual[2] = T(along * sqrt_confidence) * (x[2] - T(target.z()));
    return true;
  }
};

/// Holds a surface along itself by long point tracks, see PointTracks: where
/// Eq. 5 lets it slide, and where colours repeat themselves. Not in the paper.
///
/// As of LiveToModelTerm, the sum over all tracks is divided by the sum of
/// their confidences and of those of the correspondences.
class TracksTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("depth", &depth_, Range::AtLeast(0), "",
                 "Weight of the difference of depth, in its standard "
                 "deviations, beside that across the view, in pixels; 0: the "
                 "image alone.");
  }

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.tracks == nullptr) return;
    std::vector<const ModelSample*> samples;
    std::vector<TrackDistance> functors;
    double total = 0;
    for (const Correspondence& c : input.correspondences) total += c.weight;
    for (const TrackedPoint& point : *input.tracks) {
      const double z = point.target.z();
      const double exactness =
          z / input.camera.fx / input.camera.noise.Sigma(z);
      samples.push_back(&point.model);
      functors.push_back({point.target.cast<double>(), std::sqrt(point.weight),
                          std::sqrt(depth_) * std::min(1.0, exactness)});
      total += point.weight;
    }
    sink->AddWarpedPoints(samples, functors, total);
  }

 private:
  double depth_ = 1;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_TRACKS_H_
