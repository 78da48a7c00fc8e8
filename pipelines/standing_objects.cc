#include "splitfusion/pipelines/standing_objects.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/trial_surface.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {
namespace {

/// Whether the pixel that shows a point is one of the background.
bool IsInView(const Eigen::Vector3f& point,
              const Rigid3f& camera_from_canonical, const LiveView& live) {
  const auto pixel = live.camera.PixelOf(camera_from_canonical * point);
  return pixel && live.labels(pixel->y(), pixel->x()) == 0;
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

/// Whether a detection has half of its pixels and of a mask's in common with
/// it.
bool IsDetected(const std::vector<StandingObject>& detected,
                const cv::Mat_<uchar>& mask) {
  const int pixels = cv::countNonZero(mask);
  return std::any_of(detected.begin(), detected.end(), [&](const auto& other) {
    return 2 * cv::countNonZero(mask & other.mask) >
           std::max(pixels, cv::countNonZero(other.mask));
  });
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
    : options_(options), tracker_(MakeTracker(options.tracker)) {}

std::vector<StandingObjects::Moving> StandingObjects::Watch(
    std::vector<StandingObject> detected,
    const std::vector<ModelSample>& samples, const LiveView& live,
    const DeformationGraph& background, const TermContext& context) {
  std::vector<Moving> moving;
  Detect(std::move(detected), live, MeanRigidMotion(background));
  DeformationGraph apart = background;
  if (mapped_.empty() || !TrackApart(samples, live, context, &apart)) {
    return moving;
  }
  std::vector<Mapped> standing;
  for (Mapped& mapped : mapped_) {
    const cv::Mat_<uchar>& mask = mapped.object.mask;
    const std::vector<ModelSample> part = SamplesWithin(mask, samples);
    const OwnMotion motion =
        FindOwnMotion(part, mask, live, apart, tracker_,
                      options_.tracker.grazing_angle * M_PI / 180);
    if (mapped.is_new) {
      for (const ModelSample& s : part) mapped.points.push_back(s.point);
      mapped.is_new = false;
    }
    if (motion.gain < options_.own_motion_gain) {
      standing.push_back(std::move(mapped));
      continue;
    }
    std::vector<Eigen::Vector3f> points =
        PointsOfThing(mapped.points, mask, live, motion.camera_from_canonical);
    moving.push_back({std::move(mapped.object), std::move(points)});
  }
  mapped_ = std::move(standing);
  return moving;
}

void StandingObjects::Detect(std::vector<StandingObject> detected,
                             const LiveView& live,
                             const Rigid3d& camera_from_canonical) {
  const Rigid3f motion = camera_from_canonical.cast<float>();
  std::vector<Mapped> mapped(detected.size());
  for (Mapped& known : mapped_) {
    if (known.points.empty()) continue;
    known.object.mask =
        MaskOf(known.points, options_.render_stride, motion, live);
    const auto in_view =
        std::count_if(known.points.begin(), known.points.end(),
                      [&](const auto& p) { return IsInView(p, motion, live); });
    if (IsDetected(detected, known.object.mask)) continue;
    known.missed += 2 * in_view > static_cast<int>(known.points.size());
    if (known.missed <= options_.split.max_missed_frames)
      mapped.push_back(std::move(known));
  }
  for (std::size_t i = 0; i < detected.size(); ++i) {
    mapped[i].object = std::move(detected[i]);
    mapped[i].is_new = true;
  }
  mapped_ = std::move(mapped);
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
  SurfaceReport report;
  return tracker_.Track(samples, /*tracks=*/{}, rest, kTrialSurface,
                        /*still=*/Rigid3d::Identity(), apart, &report, context);
}

std::vector<Eigen::Vector3f> StandingObjects::PointsOfThing(
    const std::vector<Eigen::Vector3f>& points, const cv::Mat_<uchar>& mask,
    const LiveView& live, const Rigid3d& camera_from_canonical) const {
  const cv::Mat_<uchar> thing =
      CutOut(mask, live.map, live.color, options_.split.graph_cut,
             options_.split.prior);
  const Rigid3f motion = camera_from_canonical.cast<float>();
  std::vector<Eigen::Vector3f> kept;
  const DepthTolerance<double> gate = {options_.split.prior.background_gate};
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f moved = motion * point;
    const auto pixel = live.camera.PixelOf(moved);
    if (IsInView(point, motion, live)) {
      const float depth = live.depth(pixel->y(), pixel->x());
      const DepthState state =
          ClassifyDepth(depth, moved.z(), gate.At(depth, live.camera.noise));
      if (!thing(pixel->y(), pixel->x()) || state != DepthState::kObserved) {
        continue;
      }
    }
    kept.push_back(point);
  }
  return kept;
}

}  // namespace splitfusion
