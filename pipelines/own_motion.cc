#include "splitfusion/pipelines/own_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "splitfusion/lib/energy/trial_surface.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/pipelines/surface_tracker.h"

namespace splitfusion {
namespace {

/// The live frame in which the background's pixels of `mask` are those of the
/// part, certain ones.
LiveView WithPart(const LiveView& live, const cv::Mat_<uchar>& mask) {
  LiveView view = live;
  const cv::Mat_<uchar> pixels = mask & (live.labels == 0);
  view.labels = live.labels.clone();
  view.labels.setTo(kTrialSurface, pixels);
  view.uncertain = live.uncertain.clone();
  view.uncertain.setTo(0, pixels);
  return view;
}

double Square(double value) { return value * value; }

/// Squared distances of model points to the plane of the live depth.
class Misfit {
 public:
  Misfit(const LiveView& live, double grazing_angle)
      : live_(live), min_cosine_(std::cos(grazing_angle)) {}

  /// In variances of the noise, that of three standard deviations at most; none
  /// where depth tells nothing of the point.
  std::optional<double> Of(const ModelSample& sample,
                           const Rigid3d& camera_from_canonical) const {
    const Eigen::Vector3d point =
        camera_from_canonical * sample.point.cast<double>();
    const Eigen::Vector3d normal =
        camera_from_canonical.linear() * sample.normal.cast<double>();
    const auto pixel = live_.camera.PixelOf(point.cast<float>());
    if (!pixel) return std::nullopt;
    const int u = pixel->x(), v = pixel->y();
    const int label = live_.labels(v, u);
    if (!(live_.depth(v, u) > 0) || live_.edges(v, u) != 0 ||
        (label != 0 && label != kTrialSurface) ||
        -normal.dot(point) < min_cosine_ * point.norm()) {
      return std::nullopt;
    }
    const Eigen::Vector3d seen = ToEigen(live_.map.points(v, u)).cast<double>();
    const DepthNoise& noise = live_.camera.noise;
    const double distance = normal.dot(point - seen);
    return std::min(distance * distance *
                        noise.Confidence(static_cast<float>(seen.z())) /
                        Square(noise.Sigma(noise.reference)),
                    kNoiseSigmas * kNoiseSigmas);
  }

 private:
  const LiveView& live_;
  double min_cosine_;
};

}  // namespace

std::vector<ModelSample> SamplesWithin(
    const cv::Mat_<uchar>& mask, const std::vector<ModelSample>& samples) {
  std::vector<ModelSample> part;
  for (const ModelSample& sample : samples) {
    if (mask(sample.v, sample.u)) part.push_back(sample);
  }
  return part;
}

OwnMotion FindOwnMotion(const std::vector<ModelSample>& part,
                        const cv::Mat_<uchar>& mask, const LiveView& live,
                        const DeformationGraph& background,
                        const SurfaceTracker& tracker, double grazing_angle) {
  const LiveView view = WithPart(live, mask);
  DeformationGraph graph = background;
  SurfaceReport report;
  OwnMotion result;
  if (!tracker.Track(part, /*tracks=*/{}, view, kTrialSurface,
                     /*still=*/Rigid3d::Identity(), &graph, &report)) {
    return result;
  }
  const Rigid3d still = MeanRigidMotion(background);
  const Rigid3d& moved = result.camera_from_canonical = MeanRigidMotion(graph);
  const Misfit misfit(view, grazing_angle);
  double sum = 0;
  int compared = 0;
  for (const ModelSample& sample : part) {
    const Eigen::Vector3d point = sample.point.cast<double>();
    result.way += (moved * point - still * point).norm() / part.size();
    const std::optional<double> before = misfit.Of(sample, still);
    const std::optional<double> after = misfit.Of(sample, moved);
    if (!before || !after) continue;
    sum += *before - *after;
    ++compared;
  }
  if (compared > 0) result.gain = sum / compared;
  return result;
}

}  // namespace splitfusion
