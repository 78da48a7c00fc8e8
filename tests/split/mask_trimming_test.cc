#include "splitfusion/lib/split/mask_trimming.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"

namespace splitfusion {
namespace {

/// A person at 1.5 m before a wall at 3 m, as predicted (surface 1), whose
/// detection covers something else, too.
class MaskTrimmingTest : public testing::Test {
 protected:
  /// Pixels of the mask that are left, after `other` came into the scene.
  cv::Mat_<uchar> Trimmed(const cv::Rect& other, double depth, int surface) {
    LayeredScene scene;
    scene.Add({40, 20, 40, 80}, 1.5, 1);
    const Frame before = scene.MakeFrame(0);
    SurfacePrediction prediction;
    cv::Mat_<std::uint16_t> labels;
    scene.Truth(1).convertTo(labels, CV_16U, 1.0 / 255);
    prediction.labels = labels;
    prediction.depth = before.depth;
    scene.Add(other, depth, 2);
    const Frame frame = scene.MakeFrame(1);
    const PointMap points = ComputePointMap(frame.depth, SceneCamera());
    SplitWork work{frame, points, {}, {}, {}, {}, {}, {}, {}};
    work.compared = CompareDepth(frame.depth, prediction, PriorOptions());
    work.unconfirmed = cv::Mat_<uchar>(frame.depth.size(), uchar(0));
    Segment segment;
    segment.surface = surface;
    other_ = scene.Truth(2);
    segment.mask = scene.Truth(1) | other_;
    work.segments.push_back(segment);
    TrimMasks(&work);
    EXPECT_EQ(cv::countNonZero(scene.Truth(1) & ~work.segments[0].mask), 0);
    const cv::Mat taken = segment.mask & ~work.segments[0].mask;
    EXPECT_EQ(cv::countNonZero(taken != work.unconfirmed), 0);
    return work.segments[0].mask;
  }

  int Left(const cv::Rect& other, double depth, int surface = 1) {
    const cv::Mat_<uchar> mask = Trimmed(other, depth, surface);
    return cv::countNonZero(mask & other_);
  }

  cv::Mat_<uchar> other_;
};

TEST_F(MaskTrimmingTest, SomebodyFarBehindIsTakenOut) {
  EXPECT_LT(Left({80, 40, 20, 60}, 2.6), 20);  // Its corners.
}

TEST_F(MaskTrimmingTest, ALimbWithinReachStays) {
  EXPECT_EQ(Left({80, 40, 10, 30}, 1.75), 10 * 30);
  EXPECT_EQ(Left({80, 40, 20, 60}, 1.5), 20 * 60);
}

TEST_F(MaskTrimmingTest, WhatWasNotPredictedIsNotJudged) {
  EXPECT_EQ(Left({80, 40, 20, 60}, 2.6, 0), 20 * 60);
  EXPECT_EQ(Left({80, 40, 20, 60}, 2.6, 7), 20 * 60);
}

}  // namespace
}  // namespace splitfusion
