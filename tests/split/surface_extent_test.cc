#include "splitfusion/lib/split/surface_extent.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"

namespace splitfusion {
namespace {

/// All unknown, nothing predicted.
ComparedDepth Nothing() {
  const cv::Mat_<uchar> unknown(120, 160, uchar(Agreement::kUnknown));
  return {LabelImage(120, 160, std::uint16_t(0)), unknown.clone(),
          unknown.clone()};
}

TEST(UnexplainedPixels, StandBeforeTheBackgroundAndBelongToNobodyElse) {
  ComparedDepth compared = Nothing();
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(1, compared)), 0);
  EXPECT_EQ(cv::countNonZero(UnmappedPixels(compared)), 120 * 160);
  compared.background(cv::Rect(0, 0, 30, 10)) = uchar(Agreement::kNearer);
  compared.labels(cv::Rect(10, 0, 10, 10)) = 1;
  compared.labels(cv::Rect(20, 0, 10, 10)) = 2;
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(1, compared)), 200);
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(0, compared)), 100);
  EXPECT_EQ(cv::countNonZero(UnmappedPixels(compared)), 120 * 160 - 300);
}

TEST(GrowOver, FollowsTheDepthAndStopsAtAJump) {
  LayeredScene scene;
  scene.Add({20, 20, 60, 20}, 2.0, 1).Add({80, 20, 40, 20}, 1.6, 2);
  const cv::Mat_<uchar> open = RectMask({0, 20, 160, 20});
  const cv::Mat_<uchar> extent =
      GrowOver(open, RectMask({20, 20, 10, 20}), scene.depth());
  EXPECT_EQ(cv::norm(extent, scene.Truth(1), cv::NORM_INF), 0);
}

TEST(GrowOver, NeedsASeedAndOpenPixels) {
  const LayeredScene scene;
  const cv::Mat_<uchar> nothing(120, 160, uchar(0));
  EXPECT_EQ(cv::countNonZero(GrowOver(~nothing, nothing, scene.depth())), 0);
  const cv::Mat_<uchar> seeds = RectMask({20, 20, 10, 20});
  EXPECT_EQ(
      cv::norm(GrowOver(nothing, seeds, scene.depth()), seeds, cv::NORM_INF),
      0);
}

}  // namespace
}  // namespace splitfusion
