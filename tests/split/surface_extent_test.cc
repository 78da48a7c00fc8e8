#include "splitfusion/lib/split/surface_extent.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"

namespace splitfusion {
namespace {

/// All unknown, nothing predicted.
ComparedDepth Nothing() {
  const cv::Mat_<uchar> unknown(120, 160, uchar(DepthState::kUnmeasured));
  return {LabelImage(120, 160, std::uint16_t(0)), unknown.clone(),
          unknown.clone()};
}

TEST(UnexplainedPixels, StandBeforeTheBackgroundAndBelongToNobodyElse) {
  ComparedDepth compared = Nothing();
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(1, compared)), 0);
  compared.background(cv::Rect(0, 0, 30, 10)) = uchar(DepthState::kOccluded);
  compared.labels(cv::Rect(10, 0, 10, 10)) = 1;
  compared.labels(cv::Rect(20, 0, 10, 10)) = 2;
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(1, compared)), 200);
  EXPECT_EQ(cv::countNonZero(UnexplainedPixels(0, compared)), 100);
}

TEST(GrowOver, FollowsTheDepthAndStopsAtAJump) {
  LayeredScene scene;
  scene.Add({20, 20, 60, 20}, 2.0, 1).Add({80, 20, 40, 20}, 1.6, 2);
  const cv::Mat_<uchar> open = RectMask({0, 20, 160, 20});
  const cv::Mat_<uchar> extent =
      GrowOver(open, RectMask({20, 20, 10, 20}), scene.depth(), DepthNoise());
  EXPECT_EQ(cv::norm(extent, scene.Truth(1), cv::NORM_INF), 0);
}

TEST(GrowOver, NeedsASeedAndOpenPixels) {
  const LayeredScene scene;
  const cv::Mat_<uchar> nothing(120, 160, uchar(0));
  EXPECT_EQ(cv::countNonZero(
                GrowOver(~nothing, nothing, scene.depth(), DepthNoise())),
            0);
  const cv::Mat_<uchar> seeds = RectMask({20, 20, 10, 20});
  EXPECT_EQ(cv::norm(GrowOver(nothing, seeds, scene.depth(), DepthNoise()),
                     seeds, cv::NORM_INF),
            0);
}

/// Card 1 where it was predicted, with an arm in front of the background and
/// another one where nothing is mapped.
class RaisedArms : public testing::Test {
 protected:
  RaisedArms() {
    scene_.Add(body_, 2.0, 1).Add(mapped_arm_, 2.0, 1).Add(open_arm_, 2.0, 1);
    compared_.labels(body_) = 1;
    compared_.agreement(body_) = uchar(DepthState::kObserved);
    compared_.background(mapped_arm_) = uchar(DepthState::kOccluded);
  }
  static double Difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_INF);
  }

  const cv::Rect body_{50, 40, 40, 60};
  const cv::Rect mapped_arm_{90, 50, 30, 10};
  const cv::Rect open_arm_{20, 50, 30, 10};
  LayeredScene scene_;
  ComparedDepth compared_ = Nothing();
};

TEST_F(RaisedArms, BelongToAMissedSurfaceUnlessSomebodyElseHasThem) {
  const cv::Mat_<uchar> nobody(120, 160, uchar(0));
  EXPECT_EQ(Difference(MissedExtent(1, nobody, compared_, scene_.depth()),
                       RectMask(body_) | RectMask(mapped_arm_)),
            0);
  EXPECT_EQ(Difference(MissedExtent(1, RectMask(mapped_arm_), compared_,
                                    scene_.depth()),
                       RectMask(body_)),
            0);
}

TEST_F(RaisedArms, StandOutOfADetectedSurfaceBeforeTheBackgroundOnly) {
  LabelImage labels(120, 160, std::uint16_t(0));
  labels(body_) = 1;
  const cv::Mat_<uchar> none(120, 160, uchar(0));
  EXPECT_EQ(Difference(Protrusions(labels, none, compared_, scene_.depth()),
                       RectMask(mapped_arm_)),
            0);
  EXPECT_EQ(Difference(
                Protrusions(labels, RectMask(body_), compared_, scene_.depth()),
                RectMask(mapped_arm_) | RectMask(open_arm_)),
            0);
}

}  // namespace
}  // namespace splitfusion
