#include "splitfusion/lib/sequence/depth_filter.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

/// Left half at 1 m, right half at 2 m.
cv::Mat_<float> Step() {
  cv::Mat_<float> depth(20, 20, 1.0f);
  depth.colRange(10, 20) = 2.0f;
  return depth;
}

TEST(DepthInMetres, ScalesAndKeepsHoles) {
  const cv::Mat raw = (cv::Mat_<std::uint16_t>(1, 3) << 0, 5000, 12345);
  const cv::Mat_<float> depth = DepthInMetres(raw, 5000);
  EXPECT_FLOAT_EQ(depth(0, 0), 0.0f);
  EXPECT_FLOAT_EQ(depth(0, 1), 1.0f);
  EXPECT_FLOAT_EQ(depth(0, 2), 2.469f);
}

TEST(FilterDepth, DropsWhatIsOutOfRange) {
  const cv::Mat depth = (cv::Mat_<float>(1, 4) << 0.3f, 0.5f, 4.9f, 5.1f);
  const cv::Mat_<float> filtered = FilterDepth(depth, {});
  EXPECT_FLOAT_EQ(filtered(0, 0), 0.0f);
  EXPECT_FLOAT_EQ(filtered(0, 1), 0.5f);
  EXPECT_FLOAT_EQ(filtered(0, 2), 4.9f);
  EXPECT_FLOAT_EQ(filtered(0, 3), 0.0f);
}

TEST(RemoveFlyingPixels, DropsPixelsBetweenTwoSurfaces) {
  cv::Mat depth = Step();
  depth.at<float>(5, 10) = 1.5f;
  depth.at<float>(12, 9) = 1.3f;
  RemoveFlyingPixels({}, &depth);
  EXPECT_EQ(depth.at<float>(5, 10), 0.0f);
  EXPECT_EQ(depth.at<float>(12, 9), 0.0f);
  EXPECT_EQ(cv::countNonZero(depth), 398);
}

TEST(RemoveFlyingPixels, DropsAColumnOfMixedPixels) {
  cv::Mat depth = Step();
  depth.col(10) = 1.5f;
  RemoveFlyingPixels({}, &depth);
  EXPECT_EQ(cv::countNonZero(depth.col(10).rowRange(1, 19)), 0);
}

TEST(RemoveFlyingPixels, KeepsCleanEdgesAndSlopes) {
  cv::Mat edge = Step();
  RemoveFlyingPixels({}, &edge);
  EXPECT_EQ(cv::countNonZero(edge), 400);
  cv::Mat_<float> slope(20, 20);
  for (int u = 0; u < 20; ++u) slope.col(u) = 1.0f + 0.015f * u;
  cv::Mat kept = slope.clone();
  RemoveFlyingPixels({}, &kept);
  EXPECT_EQ(cv::countNonZero(kept), 400);
}

TEST(RemoveFlyingPixels, KeepsWhatIsNoiseOfTheSensor) {
  cv::Mat_<float> depth(20, 20, 1.0f);
  depth.colRange(10, 20).setTo(1.2f);
  depth.col(10).setTo(1.1f);
  DepthNoise coarse;
  coarse.least = 0.05;
  cv::Mat kept = depth.clone(), cleaned = depth.clone();
  RemoveFlyingPixels(coarse, &kept);
  RemoveFlyingPixels({}, &cleaned);
  EXPECT_EQ(cv::countNonZero(kept), 400);
  EXPECT_LT(cv::countNonZero(cleaned), 400);
}

TEST(DepthOptions, NamesFieldValueAndBound) {
  DepthOptions options;
  options.max_depth = 0.2;
  ExpectInputError([&] { options.Check(); },
                   "max_depth = 0.2: expected metres > min_depth");
  options = {};
  options.noise.least = 0;
  ExpectInputError([&] { options.Check(); },
                   "noise_least = 0: expected metres > 0");
  options.noise = {};
  options.noise.best = 2;
  ExpectInputError([&] { options.Check(); },
                   "noise_reference = 1.4: expected metres >= noise_best");
}

}  // namespace
}  // namespace splitfusion
