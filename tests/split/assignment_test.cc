#include "splitfusion/lib/split/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "split/layered_scene.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/split/hungarian.h"

namespace splitfusion {
namespace {

/// The greatest sum of gains of any one-to-one assignment, by trying all.
double BestSum(const cv::Mat_<double>& gains) {
  const int size = gains.rows + gains.cols;
  std::vector<int> column(size);
  std::iota(column.begin(), column.end(), 0);
  double best = 0;
  do {
    double sum = 0;
    for (int row = 0; row < gains.rows; ++row) {
      if (column[row] < gains.cols) sum += gains(row, column[row]);
    }
    best = std::max(best, sum);
  } while (std::next_permutation(column.begin(), column.end()));
  return best;
}

TEST(AssignRows, FindsTheGreatestSum) {
  cv::RNG random(1);
  for (int i = 0; i < 40; ++i) {
    cv::Mat_<double> gains(random.uniform(1, 5), random.uniform(0, 4));
    for (double& gain : gains) gain = random.uniform(-2.0, 4.0);
    const std::vector<int> columns = AssignRows(gains);
    double sum = 0;
    std::vector<int> taken;
    for (int row = 0; row < gains.rows; ++row) {
      if (columns[row] < 0) continue;
      EXPECT_GT(gains(row, columns[row]), 0);
      sum += gains(row, columns[row]);
      taken.push_back(columns[row]);
    }
    std::sort(taken.begin(), taken.end());
    EXPECT_EQ(std::unique(taken.begin(), taken.end()), taken.end());
    EXPECT_NEAR(sum, BestSum(gains), 1e-12) << gains;
  }
}

/// Two people, seen in frame 0 as surfaces 1 (left) and 2 (right).
class AssignmentTest : public testing::Test {
 protected:
  AssignmentTest() : agreement_(120, 160, uchar(DepthState::kObserved)) {
    scene_.Add(kLeft, 2.0, 1).Add(kRight, 2.0, 2);
    Look(scene_);
    labels_ = LabelImage::zeros(120, 160);
    for (const int id : {1, 2}) {
      AddTrack(0, "person", SurfaceKind::kNonRigid, &tracks_);
      AddView(Of(scene_.Truth(id)).appearance, &tracks_.at(id).appearance);
      labels_.setTo(id, scene_.Truth(id));
    }
  }
  void Look(LayeredScene& scene) {
    frame_ = scene.MakeFrame(0);
    points_ = ComputePointMap(frame_.depth, SceneCamera());
  }
  Candidate Of(const cv::Mat_<uchar>& mask) const {
    Candidate candidate;
    candidate.mask = mask;
    candidate.class_name = "person";
    candidate.appearance =
        ComputeAppearance(frame_.color, points_, mask, Rigid3d::Identity());
    return candidate;
  }
  std::vector<Match> Run(const std::vector<Candidate>& candidates,
                         int frame = 1) const {
    return AssignDetections(
        candidates, {tracks_, tentative_.all(), labels_, agreement_, frame},
        {});
  }
  /// Nothing of a surface was predicted.
  void Hide(int id) { labels_.setTo(0, labels_ == id); }

  const cv::Rect kLeft{10, 20, 40, 80};
  const cv::Rect kRight{90, 20, 40, 80};
  LayeredScene scene_;
  Frame frame_;
  PointMap points_;
  TrackTable tracks_;
  TentativeTracks tentative_;
  LabelImage labels_;
  cv::Mat_<uchar> agreement_;
};

TEST_F(AssignmentTest, PairsByOverlap) {
  const std::vector<Match> matches =
      Run({Of(RectMask({95, 20, 40, 80})), Of(RectMask({12, 25, 40, 80}))});
  EXPECT_EQ(matches[0].surface, 2);
  EXPECT_EQ(matches[1].surface, 1);
  EXPECT_NEAR(matches[0].iou, 35.0 / 45, 1e-9);
}

TEST_F(AssignmentTest, KnowsThePiecesOfASurface) {
  const std::vector<Match> matches =
      Run({Of(RectMask({10, 20, 40, 15})), Of(RectMask({10, 35, 40, 65}))});
  EXPECT_EQ(matches[0].surface, 1);
  EXPECT_TRUE(matches[0].piece);
  EXPECT_EQ(matches[1].surface, 1);
  EXPECT_FALSE(matches[1].piece);
}

TEST_F(AssignmentTest, TwoWhoSwappedPlacesAreKnownByTheirColours) {
  LayeredScene swapped;
  swapped.Add(kLeft, 2.0, 2).Add(kRight, 2.0, 1);
  Look(swapped);
  tracks_.at(1).last_detected_frame = tracks_.at(2).last_detected_frame = 0;
  const std::vector<Match> matches =
      Run({Of(RectMask(kLeft)), Of(RectMask(kRight))}, 30);
  EXPECT_EQ(matches[0].surface, 2);
  EXPECT_EQ(matches[1].surface, 1);
}

TEST_F(AssignmentTest, WhoComesOutOfHidingIsKnownByColourAndPlace) {
  Hide(1);
  LayeredScene scene;
  const cv::Rect beside(55, 20, 34, 80);
  scene.Add(beside, 2.0, 1).Add(kRight, 2.0, 2);
  Look(scene);
  const std::vector<Match> matches =
      Run({Of(RectMask(beside)), Of(RectMask(kRight))}, 10);
  EXPECT_EQ(matches[0].surface, 1);
  EXPECT_EQ(matches[1].surface, 2);
}

TEST_F(AssignmentTest, SomebodyElseIsSomebodyElse) {
  Hide(1);
  tracks_.at(1).Apply(TrackEvent::kGone);
  LayeredScene scene;
  scene.Add(kLeft, 2.0, 3).Add(kRight, 2.0, 2);
  Look(scene);
  EXPECT_EQ(Run({Of(RectMask(kLeft))}, 40)[0].surface, 0);
}

TEST_F(AssignmentTest, WhoLeftIsKnownWhereverHeReturns) {
  Hide(1);
  tracks_.at(1).Apply(TrackEvent::kGone);
  LayeredScene scene;
  const cv::Rect there(60, 20, 25, 80);
  scene.Add(there, 2.8, 1).Add(kRight, 2.0, 2);
  Look(scene);
  EXPECT_EQ(Run({Of(RectMask(there))}, 100)[0].surface, 1);
}

TEST_F(AssignmentTest, WhoWasMergedTakesNoPart) {
  Hide(1);
  EXPECT_EQ(Run({Of(RectMask(kLeft))})[0].surface, 1);
  tracks_.at(1).merged_into = 2;
  EXPECT_NE(Run({Of(RectMask(kLeft))})[0].surface, 1);
}

TEST_F(AssignmentTest, UntrustedDetectionsNeedMore) {
  LayeredScene other;  // Nobody's colours, at one's place.
  other.Add(kLeft, 2.0, 3);
  Look(other);
  Candidate part = Of(RectMask({10, 20, 40, 32}));
  EXPECT_EQ(Run({part})[0].surface, 1);
  part.trusted = false;
  EXPECT_EQ(Run({part})[0].surface, 0);
  Candidate most = Of(RectMask({10, 20, 40, 70}));
  most.trusted = false;
  EXPECT_EQ(Run({most})[0].surface, 1);
}

TEST_F(AssignmentTest, AThingApartFromTheMapMayBeAnyRigidSurface) {
  Candidate part = Of(RectMask({10, 20, 40, 16}));
  part.trusted = false;
  const auto surface_of = [&](bool apart, SurfaceKind kind) {
    part.apart = apart;
    tracks_.at(1).kind = kind;
    return Run({part})[0].surface;
  };
  EXPECT_EQ(surface_of(true, SurfaceKind::kRigid), 1);
  EXPECT_EQ(surface_of(true, SurfaceKind::kNonRigid), 0);
  EXPECT_EQ(surface_of(false, SurfaceKind::kRigid), 0);
}

TEST_F(AssignmentTest, WhatIsBelievedToMoveIsKnownByOverlapAlone) {
  const Candidate one = Of(RectMask({60, 20, 12, 80}));
  Candidate beside = Of(RectMask({74, 20, 12, 80}));  // As like as can be.
  tentative_.Record(-1, 0, one.mask, one.appearance, true);
  beside.trusted = false;
  EXPECT_EQ(Run({beside})[0].tentative, 0);
  tentative_ = {};
  tentative_.AddMoving(one.mask, one.appearance, 0, 1);
  EXPECT_EQ(Run({beside})[0].tentative, -1);
  EXPECT_EQ(Run({one})[0].tentative, 0);
}

TEST_F(AssignmentTest, TentativeTracksTakePart) {
  const cv::Rect there(60, 20, 25, 80);
  LayeredScene scene;
  scene.Add(there, 2.8, 3);
  Look(scene);
  const Candidate newcomer = Of(RectMask(there));
  EXPECT_EQ(Run({newcomer})[0].tentative, -1);
  tentative_.Record(-1, 0, newcomer.mask, newcomer.appearance, true);
  const Match match = Run({newcomer})[0];
  EXPECT_EQ(match.tentative, 0);
  EXPECT_EQ(match.surface, 0);
}

TEST_F(AssignmentTest, GivenIdentitiesAloneDecide) {
  tracks_.at(1).appearance.identity = 10;
  tracks_.at(2).appearance.identity = 20;
  Candidate left = Of(RectMask(kLeft)), right = Of(RectMask(kRight));
  left.appearance.identity = 20;
  right.appearance.identity = 10;
  std::vector<Match> matches = Run({left, right});
  EXPECT_EQ(matches[0].surface, 2);
  EXPECT_EQ(matches[1].surface, 1);
  // Somebody else, though he stands where one is, is neither him nor a piece.
  left.appearance.identity = 30;
  matches = Run({left});
  EXPECT_EQ(matches[0].surface, 0);
  EXPECT_EQ(matches[0].tentative, -1);
  tentative_.Record(-1, 0, left.mask, left.appearance, true);
  EXPECT_EQ(Run({left})[0].tentative, 0);
  EXPECT_EQ(Run({right})[0].tentative, -1);
}

TEST_F(AssignmentTest, OverlapCountsWhatIsAtTheSurfacesDepth) {
  agreement_(cv::Rect(10, 20, 40, 20)) =
      static_cast<uchar>(DepthState::kOccluded);
  const Overlap overlap =
      ComputeOverlap(RectMask({10, 20, 20, 80}), 1, labels_, agreement_);
  EXPECT_DOUBLE_EQ(overlap.iou, 60.0 / 140);  // 20 rows are occluded.
  EXPECT_DOUBLE_EQ(overlap.contained, 0.75);
}

/// Somebody (1) left, and came back unrecognised, as surface 3.
class FindReturnedTest : public AssignmentTest {
 protected:
  FindReturnedTest() {
    tracks_.at(1).Apply(TrackEvent::kGone);
    AddTrack(40, "person", SurfaceKind::kNonRigid, &tracks_);
  }
  /// Who surface 3 is after a view of these pixels.
  int Seen(const cv::Mat_<uchar>& mask) {
    AddView(Of(mask).appearance, &tracks_.at(3).appearance);
    return FindReturned(tracks_.at(3), tracks_, 41, {});
  }
};

TEST_F(FindReturnedTest, KnowsHimAsSoonAsEnoughOfHimIsInView) {
  EXPECT_EQ(Seen(RectMask({150, 20, 10, 40})), 0);  // Wall, by mistake.
  EXPECT_EQ(Seen(RectMask({10, 20, 20, 80})), 1);
}

TEST_F(FindReturnedTest, OtherPeopleAreOthers) {
  EXPECT_EQ(Seen(RectMask({90, 20, 20, 80})), 0);
}

TEST_F(FindReturnedTest, WhoIsSeenAtTheSameTimeIsAnother) {
  tracks_.at(1).last_detected_frame = 40;
  EXPECT_EQ(Seen(RectMask({10, 20, 20, 80})), 0);
}

TEST_F(FindReturnedTest, OnceMoreOfHimWasSeenTheDecisionStands) {
  Seen(RectMask({90, 20, 40, 80}));
  Seen(RectMask({10, 20, 40, 80}));
  EXPECT_EQ(Seen(RectMask({10, 20, 40, 80})), 0);
}

}  // namespace
}  // namespace splitfusion
