#include "splitfusion/lib/split/surface_prediction.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

const cv::Size kSize(4, 3);

/// Id and depth of every pixel of a row by row, nothing elsewhere.
SurfacePrediction Row(int row, int id, float depth) {
  SurfacePrediction made{
      LabelImage(kSize, 0), cv::Mat_<float>(kSize, 0.0f), {}};
  made.labels.row(row) = id;
  made.depth.row(row) = depth;
  return made;
}

TEST(CompletePrediction, IsZeroWithoutAnythingKnown) {
  const SurfacePrediction made = CompletePrediction({}, {}, {1}, kSize);
  EXPECT_EQ(made.labels.size(), kSize);
  EXPECT_EQ(cv::countNonZero(made.labels), 0);
  EXPECT_EQ(cv::countNonZero(made.depth), 0);
}

TEST(CompletePrediction, IsTheFrameBeforeWithoutAPrediction) {
  const SurfacePrediction made =
      CompletePrediction({}, Row(1, 2, 1.5f), {2}, kSize);
  EXPECT_EQ(made.labels(1, 0), 2);
  EXPECT_EQ(made.depth(1, 3), 1.5f);
}

TEST(CompletePrediction, OnlyFollowedSurfacesThatItLacksAreFilledIn) {
  const SurfacePrediction prediction = Row(0, 1, 1.0f);
  SurfacePrediction last = Row(1, 2, 2.0f);
  last.labels.row(2) = 3;  // No longer followed.
  last.labels(0, 0) = 2;   // Behind surface 1 by now.
  last.labels(1, 0) = 1;   // Surface 1 is predicted elsewhere.
  const SurfacePrediction made =
      CompletePrediction(prediction, last, {1, 2}, kSize);
  EXPECT_EQ(made.labels(0, 0), 1);
  EXPECT_EQ(made.labels(1, 0), 0);
  EXPECT_EQ(made.labels(1, 1), 2);
  EXPECT_EQ(made.depth(1, 1), 2.0f);
  EXPECT_EQ(made.labels(2, 1), 0);
  EXPECT_EQ(prediction.labels(1, 1), 0);  // Left as it was.
}

}  // namespace
}  // namespace splitfusion
