#include "splitfusion/lib/synthetic/kinect_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/synthetic/synthetic_options.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

PinholeCamera Camera() { return SyntheticCamera(SyntheticOptions()); }

cv::Mat_<float> Wall(float depth) { return cv::Mat_<float>(480, 640, depth); }

struct Statistics {
  double mean = 0;         // Of the error, metres.
  double sigma = 0;        // Metres.
  double correlation = 0;  // Of horizontal neighbours.
  double valid = 0;        // Part of the pixels.
};

Statistics ErrorStatistics(const cv::Mat_<float>& measured, float depth) {
  double n = 0, sum = 0, squares = 0, pairs = 0, products = 0;
  for (int v = 0; v < measured.rows; ++v) {
    for (int u = 1; u < measured.cols; ++u) {
      if (measured(v, u) == 0) continue;
      const double error = measured(v, u) - depth;
      n += 1;
      sum += error;
      squares += error * error;
      if (measured(v, u - 1) == 0) continue;
      pairs += 1;
      products += error * (measured(v, u - 1) - depth);
    }
  }
  const double mean = sum / n;
  const double variance = squares / n - mean * mean;
  return {mean, std::sqrt(variance),
          (products / pairs - mean * mean) / variance,
          n / static_cast<double>(measured.total())};
}

TEST(KinectNoise, AxialErrorFollowsTheModelAndIsUnbiased) {
  for (const float depth : {0.8f, 1.5f, 2.5f, 3.5f}) {
    const Statistics s =
        ErrorStatistics(ApplyKinectNoise(Wall(depth), Camera(), 3), depth);
    EXPECT_NEAR(s.sigma, DepthNoise().Sigma(depth),
                0.1 * DepthNoise().Sigma(depth))
        << depth;
    EXPECT_LT(std::abs(s.mean), 0.05 * DepthNoise().Sigma(depth)) << depth;
    EXPECT_GT(s.valid, 0.98) << depth;
  }
}

TEST(KinectNoise, NeighboursShareTheirError) {
  const cv::Mat measured = ApplyKinectNoise(Wall(1.5f), Camera(), 3);
  EXPECT_GT(ErrorStatistics(measured, 1.5f).correlation, 0.4);
  KinectNoiseOptions independent;
  independent.correlated_part = 0;
  const cv::Mat white = ApplyKinectNoise(Wall(1.5f), Camera(), 3, independent);
  EXPECT_NEAR(ErrorStatistics(white, 1.5f).correlation, 0, 0.05);
}

TEST(KinectNoise, DisparityComesInSteps) {
  const KinectNoiseOptions options;
  const cv::Mat_<float> measured =
      ApplyKinectNoise(Wall(3.0f), Camera(), 3, options);
  for (const float depth : measured) {
    if (depth == 0) continue;
    const double steps =
        options.focal_times_baseline / depth / options.disparity_step_px;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(KinectNoise, NothingIsMeasuredOutsideTheRange) {
  for (const float depth : {0.3f, 4.8f}) {
    const cv::Mat measured = ApplyKinectNoise(Wall(depth), Camera(), 3);
    EXPECT_LT(cv::countNonZero(measured), 10) << depth;
  }
  const Statistics far =
      ErrorStatistics(ApplyKinectNoise(Wall(4.3f), Camera(), 3), 4.3f);
  EXPECT_LT(far.valid, 0.9);
}

TEST(KinectNoise, PixelsWithoutASurfaceStayEmpty) {
  const cv::Mat measured = ApplyKinectNoise(Wall(0), Camera(), 3);
  EXPECT_EQ(cv::countNonZero(measured), 0);
}

TEST(KinectNoise, GrazingSurfacesAreLost) {
  // A floor 0.4 m below the camera, seen at 80 degrees beyond 2.3 m.
  const PinholeCamera camera = Camera();
  cv::Mat_<float> floor(480, 640, 0.0f);
  for (int v = 0; v < 480; ++v) {
    const double below = (v - camera.cy) / camera.fy;
    if (below > 0.1) floor.row(v) = static_cast<float>(0.4 / below);
  }
  const cv::Mat_<float> measured = ApplyKinectNoise(floor, camera, 3);
  const int grazing_row = static_cast<int>(camera.cy + 0.15 * camera.fy);
  const int steep_row = static_cast<int>(camera.cy + 0.42 * camera.fy);
  EXPECT_LT(cv::countNonZero(measured.row(grazing_row)), 20);
  EXPECT_GT(cv::countNonZero(measured.row(steep_row)), 570);
}

TEST(KinectNoise, ShadowLiesLeftOfNearThings) {
  cv::Mat_<float> scene = Wall(3.0f);
  scene(cv::Rect(280, 100, 80, 200)) = 1.5f;
  const cv::Mat_<float> measured = ApplyKinectNoise(scene, Camera(), 3);
  // f b (1/1.5 - 1/3) = 13 pixels.
  const cv::Rect left(270, 120, 8, 160), right(362, 120, 8, 160);
  EXPECT_LT(cv::countNonZero(measured(left)), 0.05 * left.area());
  EXPECT_GT(cv::countNonZero(measured(right)), 0.9 * right.area());
}

TEST(KinectNoise, EdgesLosePixelsAndWobble) {
  cv::Mat_<float> scene = Wall(2.0f);
  scene(cv::Rect(0, 0, 640, 240)) = 1.5f;
  const cv::Mat_<float> measured = ApplyKinectNoise(scene, Camera(), 3);
  const cv::Mat_<float> edge = measured.rowRange(239, 241);
  const double valid = cv::countNonZero(edge) / double(edge.total());
  EXPECT_NEAR(valid, 0.65, 0.06);
  int displaced = 0;
  for (int u = 0; u < 640; ++u) displaced += measured(239, u) > 1.8f;
  EXPECT_GT(displaced, 30);
}

TEST(KinectNoise, SameSeedSameImage) {
  const cv::Mat a = ApplyKinectNoise(Wall(2), Camera(), 7);
  const cv::Mat b = ApplyKinectNoise(Wall(2), Camera(), 7);
  const cv::Mat c = ApplyKinectNoise(Wall(2), Camera(), 8);
  EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(a, c, cv::NORM_INF), 0);
}

TEST(KinectNoise, RejectsAnImageThatDoesNotFitTheCamera) {
  ExpectInputError(
      [] { ApplyKinectNoise(cv::Mat_<float>(10, 10), Camera(), 1); },
      "exact depth: expected 32FC1 of the camera's size");
  ExpectInputError(
      [] { ApplyKinectNoise(cv::Mat(480, 640, CV_16UC1), Camera(), 1); },
      "exact depth");
}

TEST(CorrelatedNoise, KeepsUnitVariance) {
  for (const double radius : {0.0, 1.1, 4.0}) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(CorrelatedNoise({640, 480}, radius, 5), mean, deviation);
    EXPECT_NEAR(deviation[0], 1, 0.05) << radius;
    EXPECT_NEAR(mean[0], 0, 0.05) << radius;
  }
}

}  // namespace
}  // namespace splitfusion
