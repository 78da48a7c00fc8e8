#include "splitfusion/lib/split/instance_matcher.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/surface_prior.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

/// Surface 1 on the left, surface 2 on the right, both where predicted.
class MatchInstancesTest : public testing::Test {
 protected:
  MatchInstancesTest()
      : labels_(120, 160, std::uint16_t(0)),
        agreement_(120, 160, uchar(DepthState::kObserved)) {
    labels_(cv::Rect(10, 20, 40, 80)) = 1;
    labels_(cv::Rect(90, 20, 40, 80)) = 2;
  }
  std::vector<Match> Run(const std::vector<Candidate>& candidates,
                         const std::set<int>& surfaces = {1, 2}) const {
    return MatchInstances(candidates, labels_, agreement_, surfaces, {});
  }

  LabelImage labels_;
  cv::Mat_<uchar> agreement_;
};

TEST_F(MatchInstancesTest, PairsByOverlap) {
  const std::vector<Match> matches =
      Run({{RectMask({95, 20, 40, 80})}, {RectMask({12, 25, 40, 80})}});
  EXPECT_EQ(matches[0].surface, 2);
  EXPECT_EQ(matches[1].surface, 1);
  EXPECT_NEAR(matches[0].iou, 35.0 / 45, 1e-9);
}

TEST_F(MatchInstancesTest, GivesASurfaceToItsBestDetection) {
  const std::vector<Match> matches =
      Run({{RectMask({10, 20, 60, 80})}, {RectMask({10, 20, 42, 80})}});
  EXPECT_EQ(matches[1].surface, 1);
  EXPECT_FALSE(matches[1].piece);
}

TEST_F(MatchInstancesTest, KnowsThePiecesOfASurface) {
  const std::vector<Match> matches =
      Run({{RectMask({10, 20, 40, 15})}, {RectMask({10, 35, 40, 65})}});
  EXPECT_EQ(matches[0].surface, 1);
  EXPECT_TRUE(matches[0].piece);
  EXPECT_EQ(matches[1].surface, 1);
  EXPECT_FALSE(matches[1].piece);
}

TEST_F(MatchInstancesTest, FollowsASurfaceThatComesIntoView) {
  labels_(cv::Rect(10, 20, 40, 80)) = 0;
  labels_(cv::Rect(0, 80, 10, 20)) = 1;
  EXPECT_EQ(Run({{RectMask({0, 20, 40, 80})}})[0].surface, 1);
}

TEST_F(MatchInstancesTest, SomethingAtAnotherDepthIsSomethingElse) {
  agreement_(cv::Rect(0, 0, 80, 120)) =
      static_cast<uchar>(DepthState::kOccluded);
  EXPECT_EQ(Run({{RectMask({10, 20, 40, 80})}})[0].surface, 0);
}

TEST_F(MatchInstancesTest, WeakDetectionsMustFitWell) {
  const cv::Mat_<uchar> half = RectMask({10, 20, 40, 30});
  const cv::Mat_<uchar> most = RectMask({10, 20, 40, 60});
  EXPECT_EQ(Run({{half, Trust::kFull}})[0].surface, 1);
  EXPECT_EQ(Run({{half, Trust::kMatched}})[0].surface, 0);
  EXPECT_EQ(Run({{most, Trust::kMatched}})[0].surface, 1);
}

TEST_F(MatchInstancesTest, OnlyListedSurfacesTakePart) {
  EXPECT_EQ(Run({{RectMask({10, 20, 40, 80})}}, {2})[0].surface, 0);
}

TEST_F(MatchInstancesTest, OverlapCountsEveryShare) {
  agreement_(cv::Rect(10, 20, 40, 20)) =
      static_cast<uchar>(DepthState::kOccluded);
  const Overlap overlap =
      ComputeOverlap(RectMask({10, 20, 20, 80}), 1, labels_, agreement_);
  EXPECT_DOUBLE_EQ(overlap.iou, 0.5);
  EXPECT_DOUBLE_EQ(overlap.covered, 0.5);
  EXPECT_DOUBLE_EQ(overlap.agreement, 0.75);
  EXPECT_DOUBLE_EQ(overlap.contained, 0.75);
}

TEST(MatchOptions, NamesFieldAndBound) {
  MatchOptions options;
  options.min_contained = 0;
  ExpectInputError([&] { options.Check(); }, "min_contained = 0");
}

}  // namespace
}  // namespace splitfusion
