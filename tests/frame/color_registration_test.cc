#include "splitfusion/lib/frame/color_registration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "support/two_cameras.h"

namespace splitfusion {
namespace {

/// Pixels beside an edge of depth, where half a pixel decides.
cv::Mat NearEdges(const cv::Mat& depth) {
  cv::Mat high, low;
  const cv::Mat window = cv::Mat::ones(5, 5, CV_8U);
  cv::dilate(depth, high, window);
  cv::erode(depth, low, window);
  return high - low > 0.01;
}

TEST(ColorRegistration, ShowsWhatTheDepthCameraWouldSee) {
  const PinholeCamera camera = BoardsCamera();
  const ColorCamera color_camera = BoardsColorCamera();
  const Frame apart = BoardsFrame(3, camera, color_camera);
  const Frame truth = BoardsFrame(3, camera, ColorCamera::Registered(camera));
  const cv::Mat registered = RegisterColor(
      apart.color, ColorPlaces(camera, color_camera, apart.depth));
  const cv::Mat away = NearEdges(apart.depth) == 0;
  const auto wrong = [&](const cv::Mat& color) {
    cv::Mat difference;
    cv::absdiff(color, truth.color, difference);
    cv::extractChannel(difference, difference, 0);
    return cv::countNonZero((difference > 5) & away);
  };
  // Most of what is left is wall that a board hides from the colour camera.
  EXPECT_GT(wrong(apart.color), 5000);
  EXPECT_LT(wrong(registered), 100);
}

TEST(ColorRegistration, TheColourImageMayHaveAnotherSize) {
  const PinholeCamera camera = BoardsCamera();
  const Frame truth = BoardsFrame(3, camera, ColorCamera::Registered(camera));
  for (const double scale : {3.0, 0.75}) {
    ColorCamera color_camera = BoardsColorCamera();
    color_camera.width = static_cast<int>(scale * camera.width);
    color_camera.height = static_cast<int>(scale * camera.height);
    color_camera.fx *= scale;
    color_camera.fy *= scale;
    color_camera.cx = (color_camera.width - 1) / 2.0;
    color_camera.cy = (color_camera.height - 1) / 2.0;
    const Frame apart = BoardsFrame(3, camera, color_camera);
    ASSERT_EQ(apart.color.cols, color_camera.width);
    const cv::Mat registered = RegisterColor(
        apart.color, ColorPlaces(camera, color_camera, apart.depth));
    ASSERT_EQ(registered.size(), apart.depth.size());
    cv::Mat difference;
    cv::absdiff(registered, truth.color, difference);
    cv::extractChannel(difference, difference, 0);
    const cv::Mat away = NearEdges(apart.depth) == 0;
    EXPECT_LT(cv::countNonZero((difference > 5) & away), 100) << scale;
  }
}

TEST(ColorRegistration, OfScanNetsSizesPlacesAreExact) {
  const PinholeCamera camera = {640, 480, 577.9, 578.7, 319.5, 239.5};
  ColorCamera color_camera;
  color_camera.width = 1296;
  color_camera.height = 968;
  color_camera.fx = color_camera.fy = 1170.2;
  color_camera.cx = 647.8;
  color_camera.cy = 483.8;
  Rigid3d& motion = color_camera.color_from_depth;
  motion.linear() =
      Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, -2, 1).normalized())
          .toRotationMatrix();
  motion.translation() = Eigen::Vector3d(-0.03, 0.002, 0.001);
  cv::Mat_<float> depth(camera.height, camera.width);  // A slope.
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      depth(v, u) = 1.5f + 0.001f * static_cast<float>(u + v);
    }
  }
  const cv::Mat_<cv::Vec2f> places = ColorPlaces(camera, color_camera, depth);
  for (int v = 20; v < depth.rows - 20; v += 40) {
    for (int u = 20; u < depth.cols - 20; u += 40) {
      const Eigen::Vector3d p =
          motion * (depth(v, u) * Eigen::Vector3d((u - 319.5) / 577.9,
                                                  (v - 239.5) / 578.7, 1));
      EXPECT_NEAR(places(v, u)[0], 1170.2 * p.x() / p.z() + 647.8, 0.01);
      EXPECT_NEAR(places(v, u)[1], 1170.2 * p.y() / p.z() + 483.8, 0.01);
    }
  }
}

TEST(ColorRegistration, OfAnotherSizeWhatIsHiddenHasTheColourBeside) {
  // The camera of the test below, at three times the resolution.
  const PinholeCamera camera = BoardsCamera();
  ColorCamera color_camera = ColorCamera::Registered(camera);
  color_camera.color_from_depth.translation() = Eigen::Vector3d(-0.1, 0, 0);
  color_camera.width = 3 * camera.width;
  color_camera.height = 3 * camera.height;
  color_camera.fx *= 3;
  color_camera.fy *= 3;
  color_camera.cx *= 3;
  color_camera.cy *= 3;
  cv::Mat_<float> depth(camera.height, camera.width, 2.0f);
  depth(cv::Rect(140, 100, 40, 40)) = 1;
  const cv::Mat_<cv::Vec2f> places = ColorPlaces(camera, color_camera, depth);
  EXPECT_NEAR(places(120, 160)[0], 3 * (160 - 29), 0.05);
  EXPECT_NEAR(places(20, 160)[0], 3 * (160 - 14.5), 0.05);
  EXPECT_LT(places(120, 135)[0], 3 * (140 - 29));
}

TEST(ColorRegistration, WhatIsHiddenFromTheColourCameraHasTheColourBeside) {
  // A dark board before a bright wall; the colour camera is far to the right.
  const PinholeCamera camera = BoardsCamera();
  ColorCamera color_camera = ColorCamera::Registered(camera);
  color_camera.color_from_depth.translation() = Eigen::Vector3d(-0.1, 0, 0);
  cv::Mat_<float> depth(camera.height, camera.width, 2.0f);
  depth(cv::Rect(140, 100, 40, 40)) = 1;
  cv::Mat_<cv::Vec2f> places = ColorPlaces(camera, color_camera, depth);
  // The board is seen 29 pixels to the left, the wall 14.5.
  EXPECT_NEAR(places(120, 160)[0], 160 - 29, 0.01);
  EXPECT_NEAR(places(20, 160)[0], 160 - 14.5, 0.01);
  // Wall right beside the board's left edge is behind it for that camera: its
  // own place shows the board.
  EXPECT_LT(places(120, 135)[0], 140 - 29);
}

TEST(ColorRegistration, PixelsWithoutDepthGoWithTheNearest) {
  const PinholeCamera camera = BoardsCamera();
  ColorCamera color_camera = ColorCamera::Registered(camera);
  color_camera.color_from_depth.translation() = Eigen::Vector3d(-0.1, 0, 0);
  cv::Mat_<float> depth(camera.height, camera.width, 2.0f);
  depth(120, 160) = 0;
  EXPECT_NEAR(ColorPlaces(camera, color_camera, depth)(120, 160)[0], 160 - 14.5,
              0.01);
  const cv::Mat_<cv::Vec2f> none =
      ColorPlaces(camera, color_camera, cv::Mat_<float>::zeros(240, 320));
  EXPECT_NEAR(none(120, 160)[0], 160, 0.2);
}

TEST(ColorRegistration, MasksGoWithTheirColour) {
  const PinholeCamera camera = BoardsCamera();
  ColorCamera color_camera = ColorCamera::Registered(camera);
  color_camera.color_from_depth.translation() = Eigen::Vector3d(-0.1, 0, 0);
  const cv::Mat_<float> depth(camera.height, camera.width, 1.0f);
  cv::Mat_<uchar> mask(camera.height, camera.width, uchar(0));
  mask(cv::Rect(100, 100, 20, 20)).setTo(255);
  const cv::Mat_<uchar> registered =
      RegisterMask(mask, ColorPlaces(camera, color_camera, depth));
  EXPECT_EQ(cv::boundingRect(registered), cv::Rect(129, 100, 20, 20));
}

}  // namespace
}  // namespace splitfusion
