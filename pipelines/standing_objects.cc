#include "splitfusion/pipelines/standing_objects.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/energy/trial_surface.h"
#include "splitfusion/lib/split/surface_prior.h"
#include "splitfusion/pipelines/pipeline_options.h"

namespace splitfusion {
namespace {

/// Whether the pixel that shows a point is one of the background.
bool IsInView(const Eigen::Vector3f& point,
              const Rigid3f& camera_from_canonical, const LiveView& live) {
  const auto pixel = live.camera.PixelOf(camera_from_canonical * point);
  return pixel && live.labels(pixel->y(), pixel->x()) == 0;
}

/// Z-depths of the model points in view, of every `stride`-th pixel, metres.
cv::Mat_<float> DepthOf(const std::vector<ModelSample>& samples, int stride,
                        const Rigid3f& camera_from_canonical,
                        const PinholeCamera& camera) {
  const PinholeCamera coarse = camera.Subsampled(stride);
  cv::Mat_<float> depth(coarse.height, coarse.width, 0.0f);
  for (const ModelSample& sample : samples) {
    const Eigen::Vector3f point = camera_from_canonical * sample.point;
    const auto pixel = coarse.PixelOf(point);
    if (pixel) depth(pixel->y(), pixel->x()) = point.z();
  }
  return depth;
}

/// Pixels of the background in which points of every `stride`-th pixel are
/// seen, HxW, 255; those between them, too.
cv::Mat_<uchar> MaskOf(const std::vector<Eigen::Vector3f>& points, int stride,
                       const Rigid3f& camera_from_canonical,
                       const LiveView& live) {
  cv::Mat_<uchar> mask(live.labels.size(), uchar(0));
  for (const Eigen::Vector3f& point : points) {
    const auto pixel = live.camera.PixelOf(camera_from_canonical * point);
    if (pixel) mask(pixel->y(), pixel->x()) = 255;
  }
  const int size = 2 * stride + 1;
  cv::dilate(mask, mask, cv::Mat::ones(size, size, CV_8U));
  return mask & (live.labels == 0);
}

/// Whether a detection has more than half of a mask's pixels.
bool IsDetectionOf(const StandingObject& detected,
                   const cv::Mat_<uchar>& mask) {
  return 2 * cv::countNonZero(mask & detected.mask) > cv::countNonZero(mask);
}

/// The tracker of such tries.
SurfaceTracker MakeTracker(TrackerOptions options) {
  options.association = TrackerOptions().association;
  return SurfaceTracker(
      std::move(options), SolverOptions(),
      SurfaceEnergies::Parse(PipelineOptions().terms, BuiltinTerms()));
}

}  // namespace

StandingObjects::StandingObjects(const PipelineOptions& options)
    : options_(options.split),
      stride_(options.render_stride),
      min_gain_(options.own_motion_gain),
      grazing_(options.tracker.grazing_angle * kPi<double> / 180),
      tracker_(MakeTracker(options.tracker)) {}

std::vector<StandingObjects::Moving> StandingObjects::Watch(
    std::vector<StandingObject> detected,
    const std::vector<ModelSample>& samples, const LiveView& live,
    const DeformationGraph& background, const TermContext& context) {
  std::vector<Moving> moving;
  Detect(std::move(detected), samples, live,
         MeanRigidMotion(background).cast<float>());
  DeformationGraph apart = background;
  if (mapped_.empty() || !TrackApart(samples, live, context, &apart)) {
    return moving;
  }
  std::vector<OwnMotion> motions(mapped_.size());
  tbb::parallel_for(std::size_t{0}, mapped_.size(), [&](std::size_t i) {
    const cv::Mat_<uchar>& mask = mapped_[i].object.mask;
    motions[i] = FindOwnMotion(SamplesWithin(mask, samples), mask, live, apart,
                               tracker_, grazing_);
  });
  std::vector<Mapped> standing;
  for (std::size_t i = 0; i < mapped_.size(); ++i) {
    Mapped& mapped = mapped_[i];
    const OwnMotion& motion = motions[i];
    const double gain = (mapped.gain + motion.gain) / 2;
    mapped.gain = motion.gain;
    if (gain < min_gain_ || motion.way > options_.assignment.way) {
      standing.push_back(std::move(mapped));
      continue;
    }
    std::vector<Eigen::Vector3f> points =
        PointsOfThing(mapped, live, motion.camera_from_canonical);
    moving.push_back({std::move(mapped.object), std::move(points)});
  }
  mapped_ = std::move(standing);
  return moving;
}

DepthState StandingObjects::StateOf(const Eigen::Vector3f& point, float depth,
                                    const LiveView& live) const {
  const DepthTolerance<double> gate = {options_.prior.background_gate};
  return ClassifyDepth(depth, point.z(), gate.At(depth, live.camera.noise));
}

void StandingObjects::Detect(std::vector<StandingObject> detected,
                             const std::vector<ModelSample>& samples,
                             const LiveView& live,
                             const Rigid3f& camera_from_canonical) {
  std::vector<Mapped> mapped;
  for (StandingObject& object : detected) {
    std::vector<Eigen::Vector3f> points =
        MappedPoints(object.mask, samples, live, camera_from_canonical);
    if (points.empty()) continue;
    mapped.push_back({std::move(object), 0, 0, std::move(points)});
  }
  const auto detections_end = static_cast<std::ptrdiff_t>(mapped.size());
  const cv::Mat_<float> map =
      DepthOf(samples, stride_, camera_from_canonical, live.camera);
  for (Mapped& known : mapped_) {
    known.object.mask =
        MaskOf(known.points, stride_, camera_from_canonical, live);
    bool is_detected = false;
    for (auto at = mapped.begin(); at != mapped.begin() + detections_end;
         ++at) {
      if (!IsDetectionOf(at->object, known.object.mask)) continue;
      is_detected = true;
      at->gain = std::max(at->gain, known.gain);
    }
    if (is_detected) continue;
    int in_view = 0, gone = 0;
    for (const Eigen::Vector3f& known_point : known.points) {
      if (!IsInView(known_point, camera_from_canonical, live)) continue;
      const Eigen::Vector3f point = camera_from_canonical * known_point;
      const auto pixel = live.camera.PixelOf(point);
      const float depth = map(pixel->y() / stride_, pixel->x() / stride_);
      const DepthState state = StateOf(point, depth, live);
      ++in_view;
      gone += state == DepthState::kFree || state == DepthState::kUnmeasured;
    }
    known.missed += 2 * in_view > static_cast<int>(known.points.size());
    if (2 * gone <= in_view && known.missed <= options_.max_missed_frames) {
      mapped.push_back(std::move(known));
    }
  }
  mapped_ = std::move(mapped);
}

std::vector<Eigen::Vector3f> StandingObjects::MappedPoints(
    const cv::Mat_<uchar>& mask, const std::vector<ModelSample>& samples,
    const LiveView& live, const Rigid3f& camera_from_canonical) const {
  std::vector<Eigen::Vector3f> points;
  std::size_t observed = 0;
  for (const ModelSample& sample : SamplesWithin(mask, samples)) {
    const Eigen::Vector3f point = camera_from_canonical * sample.point;
    const auto pixel = live.camera.PixelOf(point);
    if (!pixel) continue;
    points.push_back(sample.point);
    observed += StateOf(point, live.depth(pixel->y(), pixel->x()), live) ==
                DepthState::kObserved;
  }
  if (2 * observed < points.size()) points.clear();
  return points;
}

bool StandingObjects::TrackApart(const std::vector<ModelSample>& samples,
                                 const LiveView& live,
                                 const TermContext& context,
                                 DeformationGraph* apart) const {
  LiveView rest = live;  // Shares its images.
  rest.labels = live.labels.clone();
  rest.labels.setTo(kTrialSurface, live.labels == 0);
  rest.uncertain = live.uncertain.clone();
  for (const Mapped& mapped : mapped_) {
    rest.uncertain.setTo(255, mapped.object.mask);
  }
  // A quarter of the model points tell the camera's motion well enough.
  std::vector<ModelSample> thinned;
  const int step = 2 * stride_;
  for (const ModelSample& sample : samples) {
    if (sample.u % step == 0 && sample.v % step == 0) thinned.push_back(sample);
  }
  SurfaceReport report;
  return tracker_.Track(thinned, /*tracks=*/{}, rest, kTrialSurface,
                        /*still=*/Rigid3d::Identity(), apart, &report, context);
}

std::vector<Eigen::Vector3f> StandingObjects::PointsOfThing(
    const Mapped& mapped, const LiveView& live,
    const Rigid3d& camera_from_canonical) const {
  const cv::Mat_<uchar> thing = CutOut(mapped.object.mask, live.map, live.color,
                                       options_.graph_cut, options_.prior);
  const Rigid3f motion = camera_from_canonical.cast<float>();
  std::vector<Eigen::Vector3f> kept;
  for (const Eigen::Vector3f& point : mapped.points) {
    if (IsInView(point, motion, live)) {
      const Eigen::Vector3f moved = motion * point;
      const auto pixel = live.camera.PixelOf(moved);
      const float depth = live.depth(pixel->y(), pixel->x());
      if (!thing(pixel->y(), pixel->x()) ||
          StateOf(moved, depth, live) != DepthState::kObserved) {
        continue;
      }
    }
    kept.push_back(point);
  }
  return kept;
}

}  // namespace splitfusion
