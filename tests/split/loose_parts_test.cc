// Pieces of a body that neither detector nor cut gave to it.

#include "splitfusion/lib/split/loose_parts.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"

namespace splitfusion {
namespace {

constexpr double kDepth = 2.0;         // Of the body, metres.
const cv::Rect kBody(152, 40, 8, 60);  // Ends at the right border.
const cv::Rect kHead(152, 20, 8, 14);  // So does this; 9 cm above.

/// A wall that is mapped, and surface 1, of which the cards named are found.
class LoosePartsTest : public testing::Test {
 protected:
  LoosePartsTest() {
    prediction_ = {LabelImage::zeros(120, 160), cv::Mat_<float>(120, 160, 3.0f),
                   cv::Mat_<float>(120, 160, 3.0f)};
    registry_.Create(0, "person", SurfaceKind::kNonRigid);
  }

  /// Pixels of card `id` that are claimed for the segment of surface 1, as a
  /// share. `found`: cards that each are a segment, the first surface 1.
  double Claimed(LayeredScene* scene, int id,
                 const std::vector<int>& found = {1}) {
    const Frame frame = scene->MakeFrame(0);
    const PointMap points = ComputePointMap(frame.depth, SceneCamera());
    SplitWork work{frame, points, {}, {}, {}, {}, {}, {}, {}};
    work.compared = CompareDepth(frame.depth, prediction_, PriorOptions());
    work.segment_labels = LabelImage::zeros(120, 160);
    work.unconfirmed = unconfirmed_.clone();
    for (std::size_t i = 0; i < found.size(); ++i) {
      Segment segment;
      segment.surface = i == 0 ? 1 : 0;
      segment.mask = scene->Truth(found[i]);
      work.segment_labels.setTo(static_cast<double>(i + 1), segment.mask);
      work.segments.push_back(segment);
    }
    ClaimLooseParts(registry_, &work);
    const cv::Mat_<uchar> truth = scene->Truth(id);
    return cv::countNonZero((work.segment_labels == 1) & truth) /
           static_cast<double>(cv::countNonZero(truth));
  }

  SurfacePrediction prediction_;
  InstanceRegistry registry_;
  cv::Mat_<uchar> unconfirmed_ = cv::Mat_<uchar>::zeros(120, 160);
};

TEST_F(LoosePartsTest, TheHeadOfWhoeverEntersBelongsToTheBody) {
  LayeredScene scene;
  scene.Add(kBody, kDepth, 1).Add(kHead, kDepth, 2);
  EXPECT_GT(Claimed(&scene, 2), 0.8);
}

TEST_F(LoosePartsTest, WhereNothingIsMappedYetToo) {
  prediction_.depth.colRange(145, 160).setTo(0);
  prediction_.background.colRange(145, 160).setTo(0);
  LayeredScene scene;
  scene.Add(kBody, kDepth, 1).Add(kHead, kDepth, 2);
  EXPECT_GT(Claimed(&scene, 2), 0.8);
  EXPECT_LT(Claimed(&scene, 0), 0.01) << "the wall beside it";
}

TEST_F(LoosePartsTest, WhatStandsAloneInPlainViewBelongsToNobody) {
  LayeredScene scene;
  scene.Add({80, 40, 30, 60}, kDepth, 1).Add({84, 20, 12, 14}, kDepth, 2);
  EXPECT_EQ(Claimed(&scene, 2), 0);
}

TEST_F(LoosePartsTest, WhoIsInViewIsNoStripOfWhichPiecesAreMissing) {
  LayeredScene scene;
  scene.Add({60, 20, 40, 100}, kDepth, 1).Add({110, 100, 15, 20}, kDepth, 2);
  EXPECT_EQ(Claimed(&scene, 2), 0);
}

TEST_F(LoosePartsTest, AHandBesideSomebodyInFrontBelongsToWhomHeHides) {
  LayeredScene scene;
  scene.Add({50, 40, 20, 50}, kDepth, 1).Add({82, 60, 12, 12}, kDepth, 2);
  EXPECT_EQ(Claimed(&scene, 2), 0);
  scene.Add({70, 20, 12, 80}, 1.2, 3);
  EXPECT_GT(Claimed(&scene, 2, {1, 3}), 0.8);
}

TEST_F(LoosePartsTest, WhatIsFarAwayOrLargerThanTheBodyIsNoPart) {
  LayeredScene far, other_depth, large;
  far.Add(kBody, kDepth, 1).Add({100, 0, 12, 14}, kDepth, 2);
  EXPECT_EQ(Claimed(&far, 2), 0);
  other_depth.Add(kBody, kDepth, 1).Add(kHead, kDepth + 0.6, 2);
  EXPECT_EQ(Claimed(&other_depth, 2), 0);
  large.Add(kHead, kDepth, 1).Add(kBody, kDepth, 2);
  EXPECT_EQ(Claimed(&large, 2), 0);
}

TEST_F(LoosePartsTest, WhatIsMappedOrDetectedIsLeftAlone) {
  LayeredScene scene;
  scene.Add(kBody, kDepth, 1).Add(kHead, kDepth, 2);
  unconfirmed_.setTo(255, scene.Truth(2));
  EXPECT_EQ(Claimed(&scene, 2), 0);
  unconfirmed_.setTo(0);
  prediction_.depth.setTo(kDepth, scene.Truth(2));
  prediction_.background.setTo(kDepth, scene.Truth(2));
  EXPECT_EQ(Claimed(&scene, 2), 0);
}

TEST_F(LoosePartsTest, ARigidSurfaceHasNoLooseParts) {
  registry_ = InstanceRegistry();
  registry_.Create(0, "chair", SurfaceKind::kRigid);
  LayeredScene scene;
  scene.Add(kBody, kDepth, 1).Add(kHead, kDepth, 2);
  EXPECT_EQ(Claimed(&scene, 2), 0);
}

}  // namespace
}  // namespace splitfusion
