#include "splitfusion/pipelines/standing_objects.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/pipelines/surface_tracker.h"

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

}  // namespace

void StandingObjects::Detect(std::vector<StandingObject> detected,
                             int max_missed, int stride, const LiveView& live,
                             const Rigid3d& camera_from_canonical) {
  const Rigid3f motion = camera_from_canonical.cast<float>();
  std::vector<Mapped> mapped(detected.size());
  for (Mapped& known : mapped_) {
    if (known.points.empty()) continue;
    known.object.mask = MaskOf(known.points, stride, motion, live);
    const auto in_view =
        std::count_if(known.points.begin(), known.points.end(),
                      [&](const auto& p) { return IsInView(p, motion, live); });
    if (IsDetected(detected, known.object.mask)) continue;
    known.missed += 2 * in_view > static_cast<int>(known.points.size());
    if (known.missed <= max_missed) mapped.push_back(std::move(known));
  }
  for (std::size_t i = 0; i < detected.size(); ++i) {
    mapped[i].object = std::move(detected[i]);
    mapped[i].is_new = true;
  }
  mapped_ = std::move(mapped);
}

cv::Mat_<uchar> StandingObjects::Mask(cv::Size size) const {
  cv::Mat_<uchar> mask(size, uchar(0));
  for (const Mapped& mapped : mapped_) mask |= mapped.object.mask;
  return mask;
}

std::vector<StandingObjects::Moving> StandingObjects::TakeMoving(
    const std::vector<ModelSample>& samples, const LiveView& live,
    const DeformationGraph& background, const SurfaceTracker& tracker,
    double grazing_angle, double min_gain) {
  std::vector<Moving> moving;
  std::vector<Mapped> standing;
  for (Mapped& mapped : mapped_) {
    const std::vector<ModelSample> part =
        SamplesWithin(mapped.object.mask, samples);
    OwnMotion motion = FindOwnMotion(part, mapped.object.mask, live, background,
                                     tracker, grazing_angle);
    if (motion.gain >= min_gain) {
      motion.points.insert(motion.points.end(), mapped.points.begin(),
                           mapped.points.end());
      moving.push_back({std::move(mapped.object), std::move(motion)});
      continue;
    }
    if (mapped.is_new) {
      for (const ModelSample& s : part) mapped.points.push_back(s.point);
    }
    mapped.is_new = false;
    standing.push_back(std::move(mapped));
  }
  mapped_ = std::move(standing);
  return moving;
}

}  // namespace splitfusion
