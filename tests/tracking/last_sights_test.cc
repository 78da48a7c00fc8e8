#include "splitfusion/lib/tracking/last_sights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <random>

#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

const PinholeCamera kSightCamera{320, 240, 260, 260, 160, 120};
constexpr double kHalfWidth = 0.25, kHalfHeight = 0.2;  // Metres.

/// Blots of a printed cloth, by place on it.
cv::Mat_<std::uint8_t> Print() {
  cv::Mat_<std::uint8_t> print(400, 500, std::uint8_t{128});
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    const int x = static_cast<int>(random() % 500);
    const int y = static_cast<int>(random() % 400);
    cv::circle(print, {x, y}, 3 + static_cast<int>(random() % 8),
               static_cast<int>(random() % 256), cv::FILLED);
  }
  return print;
}

/// A printed plate, surface 1, which lies at `pose` (camera from plate, its
/// middle the origin and its plane z = 0), before a wall at 3 m.
LiveView ViewOfPlate(const Rigid3d& pose, bool is_printed = true) {
  const cv::Mat_<std::uint8_t> print = Print();
  cv::Mat_<float> depth(240, 320, 3.0f);
  cv::Mat color(240, 320, CV_8UC3, cv::Scalar::all(30));
  cv::Mat_<std::uint8_t> mask(240, 320, std::uint8_t{0});
  const Rigid3d plate_from_camera = pose.inverse();
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = kSightCamera.BackProject<double>(u, v, 1.0);
      const Eigen::Vector3d direction = plate_from_camera.linear() * ray;
      const double z = -plate_from_camera.translation().z() / direction.z();
      const Eigen::Vector3d p = plate_from_camera * (z * ray);
      if (!(z > 0) || std::abs(p.x()) > kHalfWidth ||
          std::abs(p.y()) > kHalfHeight) {
        continue;
      }
      depth(v, u) = static_cast<float>(z);
      mask(v, u) = 255;
      const int x = static_cast<int>(1000 * (p.x() + kHalfWidth) / 1.001);
      const int y = static_cast<int>(1000 * (p.y() + kHalfHeight) / 1.001);
      const int grey = is_printed ? print(y, x) : 128;
      color.at<cv::Vec3b>(v, u) =
          cv::Vec3b::all(cv::saturate_cast<uchar>(grey));
    }
  }
  LiveView live = MakeLiveView(kSightCamera, depth, color);
  live.labels.setTo(1, mask);
  return live;
}

Rigid3d PoseOfPlate(double turn, double x) {
  return Eigen::Translation3d(x, 0.02, 1.2) *
         MakeMotion({0.1, turn, 0}, {0, 0, 0});
}

TEST(LastSights, KnowASurfaceAgainThatTurnedAndWentAway) {
  const Rigid3d before = PoseOfPlate(-0.2, -0.2), now = PoseOfPlate(0.35, 0.2);
  LastSights sights;
  sights.Keep(1, ViewOfPlate(before), before);
  const Rigid3d predicted = MakeMotion({0, 0, 0}, {0.05, 0, 0}) * before;
  const auto motion =
      sights.FindMotion(1, ViewOfPlate(now), predicted, /*ratio=*/0.85);
  ASSERT_TRUE(motion);
  const Rigid3d off = (*motion * predicted).inverse() * now;
  EXPECT_LT(off.translation().norm(), 0.015);
  EXPECT_LT(RotationAngle(off.linear()), 0.06);
}

TEST(LastSights, KnowNothingWithoutTexture) {
  const Rigid3d before = PoseOfPlate(-0.2, -0.2), now = PoseOfPlate(0.3, 0.2);
  LastSights sights;
  sights.Keep(1, ViewOfPlate(before, false), before);
  EXPECT_FALSE(sights.FindMotion(1, ViewOfPlate(now, false), before, 0.85));
}

TEST(LastSights, AreOfOneSurfaceUntilItIsForgotten) {
  const Rigid3d pose = PoseOfPlate(0, 0);
  const LiveView live = ViewOfPlate(pose);
  LastSights sights;
  EXPECT_FALSE(sights.FindMotion(1, live, pose, 0.85));
  sights.Keep(1, live, pose);
  EXPECT_TRUE(sights.FindMotion(1, live, pose, 0.85));
  EXPECT_FALSE(sights.FindMotion(2, live, pose, 0.85));
  // Of what is nowhere in view the sight before stays.
  LiveView empty = live;
  empty.labels = empty.labels.clone();
  empty.labels.setTo(0);
  sights.Keep(1, empty, pose);
  EXPECT_TRUE(sights.FindMotion(1, live, pose, 0.85));
  EXPECT_FALSE(sights.FindMotion(1, empty, pose, 0.85));
  sights.Forget(1);
  EXPECT_FALSE(sights.FindMotion(1, live, pose, 0.85));
}

}  // namespace
}  // namespace splitfusion
