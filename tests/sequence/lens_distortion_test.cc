#include "splitfusion/lib/sequence/lens_distortion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

const PinholeCamera kCamera = {320, 240, 260, 262, 158.3, 121.7};

LensDistortion BrownConrady() {
  return {{0.2624, -0.9531, -0.0054, 0.0026, 1.1633, 0, 0, 0}};
}

LensDistortion Rational() {
  return {{0.52, -2.61, 0.0005, -0.0003, 1.51, 0.40, -2.43, 1.44}};
}

/// Where OpenCV's camera with that lens shows points, pixels.
std::vector<cv::Point2d> Projected(const std::vector<cv::Point3d>& points,
                                   const LensDistortion& lens) {
  const cv::Matx33d k(kCamera.fx, 0, kCamera.cx, 0, kCamera.fy, kCamera.cy, 0,
                      0, 1);
  const std::vector<double> coefficients(lens.coefficients.begin(),
                                         lens.coefficients.end());
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), k, coefficients, pixels);
  return pixels;
}

std::vector<cv::Point3d> PointsInView() {
  std::vector<cv::Point3d> points;
  for (double y = -0.4; y <= 0.41; y += 0.1) {
    for (double x = -0.5; x <= 0.51; x += 0.1) points.emplace_back(x, y, 1);
  }
  return points;
}

class EveryLens : public ::testing::TestWithParam<LensDistortion> {};

TEST_P(EveryLens, ShowsPointsWhereOpenCvDoes) {
  const std::vector<cv::Point3d> points = PointsInView();
  const std::vector<cv::Point2d> expected = Projected(points, GetParam());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const cv::Point2d place = GetParam().Distorted({points[i].x, points[i].y});
    EXPECT_NEAR(kCamera.fx * place.x + kCamera.cx, expected[i].x, 1e-6);
    EXPECT_NEAR(kCamera.fy * place.y + kCamera.cy, expected[i].y, 1e-6);
  }
}

/// A soft spot, whose middle can be measured to hundredths of a pixel.
void DrawSpot(const cv::Point2d& middle, cv::Mat_<cv::Vec3b>* image) {
  for (int v = 0; v < image->rows; ++v) {
    for (int u = 0; u < image->cols; ++u) {
      const double d2 = std::pow(u - middle.x, 2) + std::pow(v - middle.y, 2);
      const auto value =
          static_cast<uchar>(std::lround(250 * std::exp(-d2 / 18)));
      (*image)(v, u) = cv::Vec3b(value, value, value);
    }
  }
}

TEST_P(EveryLens, IsTakenOutOfColourToATenthOfAPixel) {
  const Undistortion undistortion(kCamera, GetParam());
  for (const cv::Point3d& point :
       {cv::Point3d(0, 0, 1), cv::Point3d(0.4, 0.3, 1),
        cv::Point3d(-0.45, 0.25, 1), cv::Point3d(0.1, -0.35, 1)}) {
    cv::Mat_<cv::Vec3b> image(kCamera.height, kCamera.width);
    const cv::Point2d distorted = Projected({point}, GetParam())[0];
    DrawSpot(distorted, &image);
    cv::Mat grey;
    cv::extractChannel(undistortion.Color(image), grey, 0);
    const cv::Moments m = cv::moments(grey);
    const double u = kCamera.fx * point.x + kCamera.cx;
    const double v = kCamera.fy * point.y + kCamera.cy;
    EXPECT_NEAR(m.m10 / m.m00, u, 0.1) << point;
    EXPECT_NEAR(m.m01 / m.m00, v, 0.1) << point;
  }
}

TEST_P(EveryLens, IsTakenOutOfDepthWithoutMixingIt) {
  // A board before a wall, as the lens shows them.
  cv::Mat_<float> depth(kCamera.height, kCamera.width, 3.0f);
  depth(cv::Rect(100, 80, 60, 60)) = 1;
  const cv::Mat_<float> result = Undistortion(kCamera, GetParam()).Depth(depth);
  int near = 0;
  for (const float z : result) {
    EXPECT_TRUE(z == 0 || z == 1 || z == 3) << z;
    near += z == 1;
  }
  EXPECT_NEAR(near, 3600, 400);
}

INSTANTIATE_TEST_SUITE_P(LensDistortion, EveryLens,
                         ::testing::Values(BrownConrady(), Rational()));

TEST(LensDistortion, DepthIsThatOfTheNearestMeasurementAround) {
  LensDistortion lens;
  const PinholeCamera camera = {5, 5, 100, 100, 2, 2};
  cv::Mat_<float> depth = cv::Mat_<float>::zeros(5, 5);
  depth(2, 2) = 1;
  depth(2, 3) = 2;
  EXPECT_EQ(cv::norm(Undistortion(camera, lens).Depth(depth), depth), 0);
  lens.coefficients[0] = 4000;  // 0.4 more of the place, at a pixel away.
  const cv::Mat_<float> wide = Undistortion(camera, lens).Depth(depth);
  EXPECT_EQ(wide(2, 3), 2) << "3.4: the nearer one is measured";
  EXPECT_EQ(wide(2, 1), 0) << "0.6: neither is";
  depth(2, 0) = 3;
  EXPECT_EQ(Undistortion(camera, lens).Depth(depth)(2, 1), 3)
      << "0.6: the farther one is";
}

TEST(LensDistortion, WithoutAnyImagesStayAsTheyAre) {
  EXPECT_TRUE(LensDistortion().IsNone());
  EXPECT_FALSE(Rational().IsNone());
  cv::Mat image(kCamera.height, kCamera.width, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 255);
  const Undistortion undistortion(kCamera, LensDistortion());
  EXPECT_EQ(cv::norm(undistortion.Color(image), image, cv::NORM_INF), 0);
}

TEST(LensDistortion, OneThroughWhichLittleWasSeenIsRefused) {
  LensDistortion lens;
  lens.coefficients[0] = 1e9;
  ExpectInputError([&] { Undistortion(kCamera, lens); },
                   "pixels were seen through it: expected a quarter or more");
}

TEST(LensDistortion, NamesACoefficientThatIsNoNumber) {
  LensDistortion lens;
  lens.coefficients[3] = std::numeric_limits<double>::infinity();
  ExpectInputError([&] { lens.Check(); }, "p2 = inf: expected a finite number");
}

}  // namespace
}  // namespace splitfusion
