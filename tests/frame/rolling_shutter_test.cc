#include "splitfusion/lib/frame/rolling_shutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "splitfusion/lib/base/median.h"
#include "support/rolling_room.h"

namespace splitfusion {
namespace {

/// Distances of the depths of two images along their rays, metres.
std::vector<float> Distances(const cv::Mat_<float>& a,
                             const cv::Mat_<float>& b) {
  std::vector<float> distances;
  for (int v = 10; v < a.rows - 10; ++v) {
    for (int u = 10; u < a.cols - 10; ++u) {
      if (a(v, u) > 0 && b(v, u) > 0) {
        distances.push_back(std::abs(a(v, u) - b(v, u)));
      }
    }
  }
  return distances;
}

TEST(RollingShutter, IsUndone) {
  const RollingRoom at_once{0}, rolling{0.03};
  const int i = 3;  // It turns by 2.5 degrees a frame.
  const Frame expected = at_once.At(i), frame = rolling.At(i);
  const double half = rolling.seconds / 2, time = RollingRoom::kInterval * i;
  const Rigid3d motion = RollingRoom::PoseAt(time + half).inverse() *
                         RollingRoom::PoseAt(time - half);
  const RollingShutter shutter(frame.depth, rolling.camera, motion);
  const float before = Median(Distances(frame.depth, expected.depth));
  const float after = Median(Distances(shutter.Depth(), expected.depth));
  EXPECT_GT(before, 0.003f);
  EXPECT_LT(after, 0.0005f);
  // Places lead to the same cells of the pattern.
  int same = 0, all = 0;
  for (int v = 20; v < frame.depth.rows - 20; v += 3) {
    for (int u = 20; u < frame.depth.cols - 20; u += 3) {
      const cv::Vec2f& place = shutter.places()(v, u);
      const cv::Point pixel(cvRound(place[0]), cvRound(place[1]));
      const bool is_inside =
          cv::Rect({0, 0}, frame.depth.size()).contains(pixel);
      if (!is_inside) continue;
      ++all;
      same += frame.color.at<cv::Vec3b>(pixel) ==
              expected.color.at<cv::Vec3b>(v, u);
    }
  }
  EXPECT_GT(same, 0.8 * all);
}

TEST(RollingShutter, NothingMovesWithoutMotion) {
  const Frame frame = RollingRoom{0}.At(3);
  const RollingShutter shutter(frame.depth, RollingRoom{0}.camera,
                               Rigid3d::Identity());
  for (const float distance : Distances(shutter.Depth(), frame.depth)) {
    ASSERT_LT(distance, 1e-5f);
  }
}

TEST(RollingShutter, DepthsOfTwoSurfacesAreNotMixed) {
  cv::Mat_<float> depth(40, 40, 1.f);
  depth.colRange(20, 40).setTo(2);
  depth.rowRange(0, 5).setTo(0);
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const PinholeCamera camera{40, 40, 60, 60, 19.5, 19.5};
  const cv::Mat_<float> unrolled =
      RollingShutter(depth, camera, motion).Depth();
  int known = 0;
  for (const float z : unrolled) {
    const bool is_one = std::abs(z - 1) < 0.03f || std::abs(z - 2) < 0.06f;
    EXPECT_TRUE(z == 0 || is_one) << z;
    known += z > 0;
  }
  EXPECT_GT(known, 1200);
}

}  // namespace
}  // namespace splitfusion
