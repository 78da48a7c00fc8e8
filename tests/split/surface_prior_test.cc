#include "splitfusion/lib/split/surface_prior.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

DepthState At(const cv::Mat_<uchar>& agreement, int u) {
  return static_cast<DepthState>(agreement(0, u));
}

TEST(CompareDepth, TellsNearerFartherAndTheSame) {
  const cv::Mat live = (cv::Mat_<float>(1, 6) << 0, 1, 1.02, 1.5, 0.5, 1.06);
  SurfacePrediction prediction;
  prediction.depth = (cv::Mat_<float>(1, 6) << 1, 0, 1, 1, 1, 1);
  prediction.labels = LabelImage(1, 6, std::uint16_t(0));
  cv::Mat_<uchar> agreement =
      CompareDepth(live, DepthNoise(), prediction, {}).agreement;
  EXPECT_EQ(At(agreement, 0), DepthState::kUnmeasured);
  EXPECT_EQ(At(agreement, 1), DepthState::kUnmeasured);
  EXPECT_EQ(At(agreement, 2), DepthState::kObserved);
  EXPECT_EQ(At(agreement, 3), DepthState::kFree);
  EXPECT_EQ(At(agreement, 4), DepthState::kOccluded);
  // The background does not move: its gate is narrower than a surface's.
  EXPECT_EQ(At(agreement, 5), DepthState::kFree);
  prediction.labels.setTo(1);
  agreement = CompareDepth(live, DepthNoise(), prediction, {}).agreement;
  EXPECT_EQ(At(agreement, 5), DepthState::kObserved);
}

TEST(CompareDepth, SeesTheBackgroundBehindASurface) {
  const cv::Mat live = (cv::Mat_<float>(1, 3) << 1.2, 2, 2);
  SurfacePrediction prediction;
  prediction.depth = (cv::Mat_<float>(1, 3) << 1, 1, 1);
  prediction.labels = LabelImage(1, 3, std::uint16_t(1));
  EXPECT_EQ(At(CompareDepth(live, DepthNoise(), prediction, {}).background, 0),
            DepthState::kUnmeasured);
  prediction.background = (cv::Mat_<float>(1, 3) << 2, 2, 0);
  const ComparedDepth compared =
      CompareDepth(live, DepthNoise(), prediction, {});
  for (int u = 0; u < 3; ++u) {
    EXPECT_EQ(At(compared.agreement, u), DepthState::kFree);
  }
  EXPECT_EQ(At(compared.background, 0), DepthState::kOccluded);
  EXPECT_EQ(At(compared.background, 1), DepthState::kObserved);
  EXPECT_EQ(At(compared.background, 2), DepthState::kUnmeasured);
}

class GatherEvidenceTest : public testing::Test {
 protected:
  GatherEvidenceTest()
      : compared_{LabelImage(120, 160, std::uint16_t(0)),
                  cv::Mat_<uchar>(120, 160, uchar(DepthState::kUnmeasured)),
                  cv::Mat_<uchar>(120, 160, uchar(DepthState::kUnmeasured))} {}

  /// Evidence at a pixel; the surface's id is 1.
  float At(const cv::Point& pixel, const cv::Mat_<uchar>& mask) const {
    const SurfaceEvidence evidence =
        GatherEvidence({1, mask, others_, extent_}, compared_,
                       SceneOptions().graph_cut, PriorOptions());
    if (!evidence.crop.contains(pixel)) return kSurelyBackground;
    return evidence.evidence(pixel - evidence.crop.tl());
  }
  void Predict(const cv::Rect& rect, int label, DepthState agreement) {
    compared_.labels(rect) = static_cast<std::uint16_t>(label);
    compared_.agreement(rect) = static_cast<uchar>(agreement);
  }

  ComparedDepth compared_;
  cv::Mat_<uchar> others_;
  cv::Mat_<uchar> extent_;
  const cv::Mat_<uchar> mask_ = RectMask({40, 40, 40, 40});
  const cv::Mat_<uchar> missed_;
};

TEST_F(GatherEvidenceTest, FollowsTheDistanceToTheMasksBorder) {
  EXPECT_GT(At({60, 60}, mask_), At({41, 60}, mask_));
  EXPECT_GT(At({41, 60}, mask_), 0);
  EXPECT_LT(At({37, 60}, mask_), 0);
  EXPECT_EQ(At({25, 60}, mask_), kSurelyBackground);
}

// The shape of the depth decides then.
TEST_F(GatherEvidenceTest, ThePredictionSpeaksAsLoudAsTheDetection) {
  const cv::Rect leg(50, 80, 10, 30);
  EXPECT_EQ(At({55, 105}, mask_), kSurelyBackground);
  Predict(leg, 1, DepthState::kObserved);
  EXPECT_EQ(At({55, 105}, mask_), 0);
  EXPECT_GT(At({55, 82}, mask_), 0);
}

TEST_F(GatherEvidenceTest, WhatLiesBehindASurfaceTellsToo) {
  const cv::Rect foot(50, 80, 10, 30);
  Predict(foot, 1, DepthState::kObserved);
  compared_.background(foot) = static_cast<uchar>(DepthState::kOccluded);
  EXPECT_GT(At({55, 105}, mask_), 0);
  compared_.background(foot) = static_cast<uchar>(DepthState::kObserved);
  EXPECT_LT(At({55, 105}, mask_), 0);
  // Another one stands before it, too.
  compared_.background(foot) = static_cast<uchar>(DepthState::kOccluded);
  others_ = RectMask(foot);
  EXPECT_EQ(At({55, 105}, mask_), 0);
}

TEST_F(GatherEvidenceTest, MasksSpeakAgainstAPixelOnce) {
  const cv::Rect body(50, 80, 10, 30);
  Predict(body, 1, DepthState::kObserved);
  others_ = RectMask(body);
  EXPECT_EQ(At({55, 105}, mask_), 0);
  others_ = RectMask({40, 40, 40, 40});
  EXPECT_EQ(At({60, 60}, mask_), 0);
}

TEST_F(GatherEvidenceTest, AMissedSurfaceIsWhereTheDepthAgrees) {
  Predict({40, 40, 40, 40}, 1, DepthState::kObserved);
  EXPECT_GT(At({60, 60}, missed_), 0);
  Predict({40, 40, 20, 40}, 1, DepthState::kFree);
  EXPECT_LT(At({50, 60}, missed_), 0);
  EXPECT_GT(At({70, 60}, missed_), 0);
}

TEST_F(GatherEvidenceTest, AMissedSurfaceMayBeInAllItsExtent) {
  Predict({40, 40, 40, 40}, 1, DepthState::kObserved);
  EXPECT_EQ(At({100, 60}, missed_), kSurelyBackground);
  extent_ = RectMask({40, 40, 80, 40});
  EXPECT_GT(At({100, 60}, missed_), 0);
}

TEST_F(GatherEvidenceTest, BackgroundAndOthersSpeakAgainst) {
  const float neutral = At({60, 60}, mask_);
  Predict({40, 40, 40, 40}, 0, DepthState::kObserved);
  EXPECT_LT(At({60, 60}, mask_), neutral);
  Predict({40, 40, 40, 40}, 0, DepthState::kOccluded);
  EXPECT_GT(At({60, 60}, mask_), neutral);
  Predict({40, 40, 40, 40}, 2, DepthState::kObserved);
  EXPECT_EQ(At({60, 60}, mask_), 0);
}

TEST_F(GatherEvidenceTest, NothingSeenMakesAnEmptyCrop) {
  const SurfaceEvidence evidence = GatherEvidence(
      {1, missed_, {}, {}}, compared_, GraphCutOptions(), PriorOptions());
  EXPECT_EQ(evidence.crop.area(), 0);
}

TEST(PriorOptions, NamesFieldAndBound) {
  PriorOptions options;
  options.mask_weight = 0;
  ExpectInputError([&] { CheckOptions(options); }, "mask_weight = 0");
  options = {};
  options.surface_gate = -1;
  ExpectInputError([&] { CheckOptions(options); },
                   "surface_gate = -1: expected metres > 0");
}

}  // namespace
}  // namespace splitfusion
