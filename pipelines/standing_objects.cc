#include "splitfusion/pipelines/standing_objects.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace splitfusion {
namespace {

/// Whether the pixel that shows a point is one of the background.
bool IsInView(const Eigen::Vector3f& point,
              const Rigid3f& camera_from_canonical, const LiveView& live) {
  const auto pixel = live.camera.PixelOf(camera_from_canonical * point);
  return pixel && live.labels(pixel->y(), pixel->x()) == 0;
}

/// Pixels at which points of every `stride`-th pixel would be seen if nothing
/// hid them, HxW, 255; those between them, too.
cv::Mat_<uchar> MaskOf(const std::vector<Eigen::Vector3f>& points, int stride,
                       const Rigid3f& camera_from_canonical,
                       const PinholeCamera& camera) {
  cv::Mat_<uchar> mask(camera.height, camera.width, uchar(0));
  for (const Eigen::Vector3f& point : points) {
    const auto pixel = camera.PixelOf(camera_from_canonical * point);
    if (pixel) mask(pixel->y(), pixel->x()) = 255;
  }
  const int size = 2 * stride + 1;
  cv::dilate(mask, mask, cv::Mat::ones(size, size, CV_8U));
  return mask;
}

/// The detection that has half of its pixels and of a mask's in common with it;
/// -1 if none has.
int FindSame(const std::vector<StandingObject>& detected,
             const cv::Mat_<uchar>& mask) {
  const int pixels = cv::countNonZero(mask);
  for (std::size_t i = 0; i < detected.size(); ++i) {
    if (2 * cv::countNonZero(mask & detected[i].mask) >
        std::max(pixels, cv::countNonZero(detected[i].mask))) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace

void StandingObjects::Detect(std::vector<StandingObject> detected,
                             int max_missed, int stride, const LiveView& live,
                             const Rigid3d& camera_from_canonical) {
  const Rigid3f motion = camera_from_canonical.cast<float>();
  std::vector<Mapped> mapped(detected.size());
  for (Mapped& known : mapped_) {
    if (known.points.empty()) continue;
    const cv::Mat_<uchar> whole =
        MaskOf(known.points, stride, motion, live.camera);
    known.object.mask = whole & (live.labels == 0);
    const auto in_view =
        std::count_if(known.points.begin(), known.points.end(),
                      [&](const auto& p) { return IsInView(p, motion, live); });
    const int index = FindSame(detected, whole);
    if (index < 0) {
      known.missed += 2 * in_view > static_cast<int>(known.points.size());
      if (known.missed <= max_missed) mapped.push_back(std::move(known));
      continue;
    }
    // What is hidden now is of the object all the same.
    for (const Eigen::Vector3f& point : known.points) {
      if (!IsInView(point, motion, live)) mapped[index].points.push_back(point);
    }
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
      if (getenv("MOVERS_DEBUG")) fprintf(stderr, "MOVES gain %.2f own %zu kept %zu\n", motion.gain, motion.points.size(), mapped.points.size());
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
