#include "splitfusion/pipelines/standing_objects.h"

#include <opencv2/imgproc.hpp>
#include <utility>

namespace splitfusion {
namespace {

/// Pixels in which points of every `stride`-th pixel are seen, HxW, 255; those
/// between them, too.
cv::Mat_<uchar> MaskOf(const std::vector<Eigen::Vector3f>& points, int stride,
                       const PinholeCamera& camera,
                       const Rigid3d& camera_from_canonical) {
  cv::Mat_<uchar> mask(camera.height, camera.width, uchar(0));
  const Rigid3f motion = camera_from_canonical.cast<float>();
  for (const Eigen::Vector3f& point : points) {
    const auto pixel = camera.PixelOf(motion * point);
    if (pixel) mask(pixel->y(), pixel->x()) = 255;
  }
  const int size = 2 * stride + 1;
  cv::dilate(mask, mask, cv::Mat::ones(size, size, CV_8U));
  return mask;
}

bool CoversHalf(const std::vector<StandingObject>& detected,
                const cv::Mat_<uchar>& mask) {
  const int pixels = cv::countNonZero(mask);
  for (const StandingObject& object : detected) {
    if (2 * cv::countNonZero(mask & object.mask) > pixels) return true;
  }
  return pixels == 0;
}

}  // namespace

void StandingObjects::Detect(std::vector<StandingObject> detected, int frame,
                             int max_missed, int stride,
                             const PinholeCamera& camera,
                             const Rigid3d& camera_from_canonical) {
  frame_ = frame;
  std::vector<Mapped> mapped;
  for (Mapped& known : mapped_) {
    known.object.mask =
        MaskOf(known.points, stride, camera, camera_from_canonical);
    if (frame - known.frame > max_missed ||
        CoversHalf(detected, known.object.mask)) {
      continue;
    }
    mapped.push_back(std::move(known));
  }
  for (StandingObject& object : detected) {
    mapped.push_back({std::move(object), frame, {}});
  }
  mapped_ = std::move(mapped);
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
      moving.push_back({std::move(mapped.object), std::move(motion)});
      continue;
    }
    if (mapped.frame == frame_) {
      mapped.points.clear();
      for (const ModelSample& s : part) mapped.points.push_back(s.point);
    }
    standing.push_back(std::move(mapped));
  }
  mapped_ = std::move(standing);
  return moving;
}

}  // namespace splitfusion
