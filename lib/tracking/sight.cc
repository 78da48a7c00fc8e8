#include "splitfusion/lib/tracking/sight.h"

#include <limits>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/tracking/agreement.h"
#include "splitfusion/lib/tracking/rigid_parts.h"

namespace splitfusion {
namespace {

/// The pixels that show a surface for sure, 255, and all others, 0.
cv::Mat_<std::uint8_t> CertainPixels(int surface, const LiveView& live) {
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

}  // namespace

std::optional<Sight> SightOf(int surface, const LiveView& live) {
  const cv::Mat_<std::uint8_t> pixels = CertainPixels(surface, live);
  const cv::Rect box = BoxAround(pixels);
  if (box.empty()) return {};
  Sight sight{box.x, box.y, {}, cv::Mat_<float>(box.size(), 0.f)};
  cv::cvtColor(live.color(box), sight.grey, cv::COLOR_BGR2GRAY);
  live.depth(box).copyTo(sight.depth, pixels(box));
  return sight;
}

Landmarks LandmarksOf(const Sight& sight, const PinholeCamera& camera,
                      int most) {
  Landmarks landmarks;
  landmarks.features = SiftFeatures(sight.grey, cv::Rect({}, sight.grey.size()),
                                    sight.depth > 0, most);
  for (const cv::Vec2f& pixel : landmarks.features.pixels) {
    landmarks.points.push_back(
        camera.BackProject(pixel[0] + static_cast<float>(sight.u),
                           pixel[1] + static_cast<float>(sight.v),
                           sight.depth(cvRound(pixel[1]), cvRound(pixel[0]))));
  }
  return landmarks;
}

std::optional<LandmarkMotion> FindLandmarkMotion(const Landmarks& before,
                                                 const Landmarks& now,
                                                 const DepthNoise& noise,
                                                 double ratio) {
  RigidPartOptions whole;
  whole.count = 1;
  whole.radius = whole.reach = std::numeric_limits<double>::max();
  whole.inlier = kAgreeingDistance;
  const double anywhere = std::numeric_limits<double>::infinity();
  std::vector<PointMotion> matches;
  for (const auto& [i, j] :
       AlikeFeatures(before.features, now.features, {anywhere, ratio, 0})) {
    matches.push_back({before.points[i], now.points[j]});
  }
  const std::vector<RigidPart> found = FindRigidParts(matches, noise, whole);
  if (found.empty()) return {};
  const RigidPart& part = found.front();
  std::vector<Eigen::Vector3f> agreeing;
  for (const int i : part.points) agreeing.push_back(matches[i].from);
  return LandmarkMotion{part.motion, static_cast<int>(part.points.size()),
                        TypicalPointsOf(agreeing)};
}

}  // namespace splitfusion
