#include "splitfusion/lib/tracking/last_sights.h"

#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/lib/tracking/agreement.h"
#include "splitfusion/lib/tracking/image_features.h"
#include "splitfusion/lib/tracking/rigid_parts.h"

namespace splitfusion {
namespace {

/// The pixels that show a surface for sure, 255, and all others, 0.
cv::Mat_<std::uint8_t> CertainPixels(const LiveView& live, int surface) {
  return (live.labels == surface) & (live.depth > 0) & (live.edges == 0) &
         (live.uncertain == 0);
}

/// A box about the pixels, with what features are described by; empty if there
/// are none.
cv::Rect BoxAround(const cv::Mat_<std::uint8_t>& pixels) {
  cv::Rect box = cv::boundingRect(pixels);
  if (box.empty()) return box;
  box -= cv::Point(kWindowMargin, kWindowMargin);
  box += cv::Size(2 * kWindowMargin, 2 * kWindowMargin);
  return box & cv::Rect({}, pixels.size());
}

cv::Mat_<std::uint8_t> GreyWithin(const LiveView& live, const cv::Rect& box) {
  cv::Mat_<std::uint8_t> grey;
  cv::cvtColor(live.color(box), grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Features of the pixels of an image that have depth.
ImageFeatures FeaturesOf(const cv::Mat_<std::uint8_t>& grey,
                         const cv::Mat_<float>& depth) {
  return SiftFeatures(grey, cv::Rect({}, grey.size()), depth > 0);
}

/// Points of features in the camera frame, metres; `box`: of the image that
/// they were found in.
std::vector<Eigen::Vector3f> Lifted(const ImageFeatures& features,
                                    const cv::Mat_<float>& depth,
                                    const cv::Point& box,
                                    const PinholeCamera& camera) {
  std::vector<Eigen::Vector3f> points;
  for (const cv::Vec2f& pixel : features.pixels) {
    const float z = depth(cvRound(pixel[1]), cvRound(pixel[0]));
    points.push_back(camera.BackProject(pixel[0] + static_cast<float>(box.x),
                                        pixel[1] + static_cast<float>(box.y),
                                        z));
  }
  return points;
}

}  // namespace

void LastSights::Keep(int surface, const LiveView& live, const Rigid3d& pose) {
  const cv::Mat_<std::uint8_t> pixels = CertainPixels(live, surface);
  const cv::Rect box = BoxAround(pixels);
  if (box.empty()) return;
  Sight sight{box.x, box.y, GreyWithin(live, box),
              cv::Mat_<float>(box.size(), 0.f), pose.matrix()};
  live.depth(box).copyTo(sight.depth, pixels(box));
  sights_[surface] = std::move(sight);
}

std::vector<PointMotion> LastSights::Match(const Sight& sight, int surface,
                                           const LiveView& live, double ratio) {
  std::vector<PointMotion> motions;
  const cv::Mat_<std::uint8_t> pixels = CertainPixels(live, surface);
  const cv::Rect box = BoxAround(pixels);
  if (box.empty()) return motions;
  cv::Mat_<float> depth(box.size(), 0.f);
  live.depth(box).copyTo(depth, pixels(box));
  const ImageFeatures before = FeaturesOf(sight.grey, sight.depth);
  const ImageFeatures now = FeaturesOf(GreyWithin(live, box), depth);
  const std::vector<Eigen::Vector3f> from =
      Lifted(before, sight.depth, {sight.u, sight.v}, live.camera);
  const std::vector<Eigen::Vector3f> to =
      Lifted(now, depth, box.tl(), live.camera);
  // Anywhere in the image.
  const double reach = std::numeric_limits<double>::infinity();
  for (const auto& [i, j] : AlikeFeatures(before, now, {reach, ratio, 0})) {
    motions.push_back({from[i], to[j]});
  }
  return motions;
}

std::optional<Rigid3d> LastSights::FindMotion(int surface, const LiveView& live,
                                              const Rigid3d& predicted,
                                              double ratio) const {
  const auto sight = sights_.find(surface);
  if (sight == sights_.end()) return {};
  RigidPartOptions whole;
  whole.count = 1;
  whole.radius = whole.reach = std::numeric_limits<double>::max();
  whole.inlier = kAgreeingDistance;
  const std::vector<RigidPart> found = FindRigidParts(
      Match(sight->second, surface, live, ratio), live.camera.noise, whole);
  if (found.empty()) return {};
  return found.front().motion * Rigid3d(sight->second.pose) *
         predicted.inverse();
}

}  // namespace splitfusion
