#include "splitfusion/lib/split/segment.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

/// A segment that claims `rect`, with the same evidence everywhere.
Segment Claim(int surface, const cv::Rect& rect, float evidence) {
  Segment segment;
  segment.surface = surface;
  segment.mask = RectMask(rect);
  segment.evidence.crop = rect;
  segment.evidence.evidence = cv::Mat_<float>(rect.size(), evidence);
  segment.foreground = cv::Mat_<uchar>(rect.size(), uchar(255));
  return segment;
}

const LabelImage kNothing(120, 160, std::uint16_t(0));
constexpr int kMinIsland = 60;
const cv::Mat kWall(120, 160, CV_32FC1, cv::Scalar(2));

TEST(ComposeSegments, TheStrongerClaimWins) {
  const LabelImage labels = ComposeSegments(
      {Claim(5, {10, 10, 40, 40}, 0.2f), Claim(7, {30, 10, 40, 40}, 0.6f)},
      kNothing, kWall, kMinIsland);
  EXPECT_EQ(labels(20, 20), 1);
  EXPECT_EQ(labels(20, 40), 2);
  EXPECT_EQ(labels(20, 60), 2);
  EXPECT_EQ(labels(80, 20), 0);
}

TEST(MasksBut, JoinsAllMasksButOne) {
  Segment missed = Claim(3, {80, 80, 10, 10}, 0.2f);
  missed.mask.release();
  const std::vector<Segment> segments = {Claim(1, {10, 10, 20, 20}, 0.2f),
                                         missed,
                                         Claim(2, {50, 10, 20, 20}, 0.2f)};
  EXPECT_EQ(cv::countNonZero(MasksBut(-1, segments, {160, 120})), 800);
  const cv::Mat_<uchar> others = MasksBut(0, segments, {160, 120});
  EXPECT_EQ(cv::norm(others, segments[2].mask, cv::NORM_INF), 0);
}

TEST(ComposeSegments, DropsIslands) {
  Segment segment = Claim(1, {10, 10, 60, 40}, 0.2f);
  segment.foreground.colRange(40, 55) = 0;
  const cv::Rect island(55, 5, 5, 5);  // Of the crop.
  segment.foreground.colRange(55, 60) = 0;
  segment.foreground(island) = 255;
  const LabelImage labels =
      ComposeSegments({segment}, kNothing, kWall, kMinIsland);
  EXPECT_EQ(labels(17, 67), 0);
  EXPECT_EQ(cv::countNonZero(labels), 40 * 40);
  EXPECT_EQ(ComposeSegments({segment}, kNothing, kWall, 0)(17, 67), 1);
}

TEST(ComposeSegments, PixelsWithoutDepthTakeTheMaskClosed) {
  Segment segment = Claim(1, {10, 10, 60, 40}, 0.2f);
  cv::Mat depth = kWall.clone();
  const cv::Rect shadow(30, 20, 10, 10);
  depth(shadow) = 0.0;
  segment.foreground(shadow - segment.evidence.crop.tl()) = 0;
  segment.mask(cv::Rect(34, 24, 3, 3)) = 0;  // A small hole of the mask.
  LabelImage labels = ComposeSegments({segment}, kNothing, depth, kMinIsland);
  EXPECT_EQ(cv::countNonZero(labels), 60 * 40);
  // A large hole of the mask stays open.
  segment.mask(cv::Rect(15, 15, 50, 30)) = 0;
  segment.foreground(cv::Rect(5, 5, 50, 30)) = 0;
  labels = ComposeSegments({segment}, kNothing, depth, kMinIsland);
  EXPECT_EQ(labels(25, 35), 0);
}

TEST(ComposeSegments, WithoutDetectionTheProjectionFillsHoles) {
  Segment segment = Claim(3, {10, 10, 60, 40}, 0.2f);
  segment.mask.release();
  cv::Mat depth = kWall.clone();
  const cv::Rect shadow(30, 20, 20, 20);
  depth(shadow) = 0.0;
  segment.foreground(shadow - segment.evidence.crop.tl()) = 0;
  EXPECT_EQ(ComposeSegments({segment}, kNothing, depth, kMinIsland)(30, 40), 0);
  LabelImage predicted = kNothing.clone();
  predicted(segment.evidence.crop) = 3;
  EXPECT_EQ(ComposeSegments({segment}, predicted, depth, kMinIsland)(30, 40),
            1);
}

}  // namespace
}  // namespace splitfusion
