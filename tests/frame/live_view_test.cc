#include "splitfusion/lib/frame/live_view.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/expect_input_error.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

LiveView View(const cv::Mat_<float>& depth) {
  return MakeLiveView(SmallCamera(), depth,
                      PlainColor(SmallCamera(), {1, 2, 3}));
}

TEST(LiveView, AWallHasPointsNormalsAndNoEdge) {
  const LiveView view = View(WallDepth(SmallCamera(), 1.2));
  EXPECT_EQ(cv::countNonZero(view.edges), 0);
  EXPECT_EQ(cv::countNonZero(view.labels), 0);
  EXPECT_EQ(cv::countNonZero(view.uncertain), 0);
  EXPECT_NEAR(view.map.points(60, 80)[2], 1.2, 1e-6);
  EXPECT_NEAR(view.map.normals(60, 80)[2], -1, 1e-4);
  // Straight ahead and near: full confidence; less in the corner.
  EXPECT_NEAR(view.confidence(60, 79), 1, 1e-3);
  EXPECT_LT(view.confidence(0, 0), 0.9);
}

TEST(LiveView, ConfidenceFallsWithTheNoiseOfDepth) {
  const DepthNoise noise;
  EXPECT_EQ(noise.Confidence(0.5f), 1);
  EXPECT_NEAR(noise.Confidence(1.4f), 1, 1e-6);
  const double ratio = noise.Sigma(1.4) / noise.Sigma(3.0);
  EXPECT_NEAR(noise.Confidence(3), ratio * ratio, 1e-6);
  EXPECT_LT(noise.Confidence(4), noise.Confidence(3));
}

TEST(LiveView, MarksBothSidesOfAStep) {
  cv::Mat_<float> depth = WallDepth(SmallCamera(), 1.5);
  depth.colRange(0, 80).setTo(1.0f);
  const LiveView view = View(depth);
  for (int u = 0; u < 160; ++u) {
    const bool near_step = u >= 78 && u <= 81;
    const bool far_from_step = u < 76 || u > 83;
    if (near_step) {
      EXPECT_EQ(view.edges(60, u), 255) << u;
    }
    if (far_from_step) {
      EXPECT_EQ(view.edges(60, u), 0) << u;
    }
  }
}

TEST(LiveView, AStepWithinTheNoiseOfTheSensorIsNone) {
  PinholeCamera camera = SmallCamera();
  cv::Mat_<float> depth = WallDepth(camera, 1.5);
  depth.colRange(0, 80).setTo(1.35f);
  const auto edges = [&] {
    return cv::countNonZero(
        MakeLiveView(camera, depth, PlainColor(camera, {1, 2, 3})).edges);
  };
  EXPECT_GT(edges(), 0);
  camera.noise.least = 0.04;
  EXPECT_EQ(edges(), 0);
}

TEST(LiveView, FillsPinholesButNoHolesAndNoEdges) {
  cv::Mat_<float> depth = WallDepth(SmallCamera(), 1.2);
  depth(60, 80) = 0;
  depth(20, 20) = std::numeric_limits<float>::quiet_NaN();
  depth(cv::Rect(100, 50, 8, 8)).setTo(0);
  cv::Mat_<float> before = depth.clone();
  const LiveView view = View(depth);
  EXPECT_NEAR(view.depth(60, 80), 1.2, 1e-6);
  EXPECT_NEAR(view.depth(20, 20), 1.2, 1e-6);
  EXPECT_EQ(view.depth(54, 104), 0);
  EXPECT_EQ(depth(60, 80), 0) << "the caller's image must stay as it is";
  depth = WallDepth(SmallCamera(), 1.2);
  depth.colRange(0, 80).setTo(0.8f);
  depth(60, 80) = 0;
  EXPECT_EQ(View(depth).depth(60, 80), 0);
}

TEST(LiveView, NothingMeasuredIsNothingSeen) {
  for (const float nothing :
       {0.f, -1.f, std::numeric_limits<float>::quiet_NaN()}) {
    const LiveView view = View(cv::Mat_<float>(120, 160, nothing));
    EXPECT_EQ(cv::countNonZero(view.confidence), 0);
    EXPECT_EQ(cv::countNonZero(view.edges), 0);
    cv::Mat z;
    cv::extractChannel(view.map.points, z, 2);
    EXPECT_EQ(cv::countNonZero(z), 0);
  }
}

TEST(LiveView, RefusesImagesThatDoNotFit) {
  const PinholeCamera camera = SmallCamera();
  const cv::Mat color = PlainColor(camera, {1, 2, 3});
  const cv::Mat_<float> depth = WallDepth(camera, 1);
  const auto refused = [&](const cv::Mat& d, const cv::Mat& c,
                           const std::string& message) {
    ExpectInputError([&] { MakeLiveView(camera, d, c); }, message);
  };
  refused(depth, cv::Mat(120, 160, CV_8UC1), "expected 8UC3 of 160x120");
  refused(depth, cv::Mat(60, 80, CV_8UC3), "colour image is 80x60");
  refused(cv::Mat(120, 160, CV_16UC1), color, "expected CV_32FC1");
  refused(cv::Mat_<float>(60, 80, 1.f), cv::Mat(60, 80, CV_8UC3),
          "depth image is 80x60");
}

}  // namespace
}  // namespace splitfusion
