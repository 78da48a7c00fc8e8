#include <gtest/gtest.h>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/appearance.h"
#include "splitfusion/lib/split/surface_contact.h"
#include "splitfusion/lib/split/tentative_tracks.h"
#include "splitfusion/lib/split/track_table.h"

namespace splitfusion {
namespace {

TEST(TrackState, FollowsItsEvents) {
  using S = TrackState;
  using E = TrackEvent;
  EXPECT_EQ(Next(S::kTentative, E::kConfirmed), S::kTracked);
  EXPECT_EQ(Next(S::kTentative, E::kFits), S::kTentative);
  for (const S state : {S::kTracked, S::kOccluded, S::kLost}) {
    EXPECT_EQ(Next(state, E::kFits), S::kTracked);
    EXPECT_EQ(Next(state, E::kMisfits), S::kLost);
    EXPECT_EQ(Next(state, E::kLittleInView), S::kOccluded);
    EXPECT_EQ(Next(state, E::kGone), S::kInactive);
    EXPECT_EQ(Next(state, E::kDetected), state);
  }
  // Who comes back is looked for before he is believed to be tracked.
  EXPECT_EQ(Next(S::kInactive, E::kDetected), S::kOccluded);
  EXPECT_EQ(Next(S::kInactive, E::kFits), S::kInactive);
}

TEST(Track, CountsTheFramesInWhichItIsLostUntilItIsTracked) {
  Track track;
  track.Apply(TrackEvent::kConfirmed);
  track.Apply(TrackEvent::kMisfits);
  track.Apply(TrackEvent::kDetected);
  track.Apply(TrackEvent::kMisfits);
  EXPECT_EQ(track.lost_frames, 2);
  track.Apply(TrackEvent::kLittleInView);
  EXPECT_EQ(track.lost_frames, 2);
  track.Apply(TrackEvent::kMisfits);
  EXPECT_EQ(track.lost_frames, 3);
  track.Apply(TrackEvent::kFits);
  EXPECT_EQ(track.lost_frames, 0);
  track.Apply(TrackEvent::kMisfits);
  track.Apply(TrackEvent::kGone);
  EXPECT_EQ(track.lost_frames, 0);
}

TEST(Track, TakesTheClassOfTheMajority) {
  Track track;
  track.Detect(0, "dog", 0.9);
  track.Detect(1, "person", 0.6);
  EXPECT_EQ(track.class_name, "dog");
  track.Detect(2, "person", 0.6);
  EXPECT_EQ(track.class_name, "person");
  EXPECT_EQ(track.last_detected_frame, 2);
}

TEST(TrackTable, GivesIdsInOrderOfBirth) {
  TrackTable tracks;
  EXPECT_EQ(AddTrack(0, "dog", SurfaceKind::kNonRigid, &tracks), 1);
  EXPECT_EQ(AddTrack(3, "chair", SurfaceKind::kRigid, &tracks), 2);
  EXPECT_EQ(tracks.at(2).first_frame, 3);
  EXPECT_EQ(tracks.at(2).state, TrackState::kTracked);
  tracks.at(1).Apply(TrackEvent::kGone);
  EXPECT_EQ(Followed(tracks), std::set<int>{2});
}

class TentativeTracksTest : public testing::Test {
 protected:
  /// Evidence after a frame in which it was detected or not.
  double Step(bool detected, bool counts = true) {
    if (detected) {
      index_ = tracks_.Record(tracks_.all().empty() ? -1 : 0, frame_, mask_, {},
                              counts);
    }
    tracks_.EndFrame(frame_++);
    return tracks_.all().empty() ? 0 : tracks_.all()[0].evidence;
  }
  const cv::Mat_<uchar> mask_ = RectMask({10, 10, 30, 30});
  TentativeTracks tracks_;
  int frame_ = 0;
  int index_ = -1;
};

TEST_F(TentativeTracksTest, EvidenceGrowsWithDetectionsAndFades) {
  EXPECT_EQ(Step(true), 1);
  EXPECT_EQ(Step(true), 2);
  EXPECT_EQ(Step(false), 1.5);
  EXPECT_EQ(Step(true, /*counts=*/false), 1);
  EXPECT_EQ(Step(false), 0.5);
  EXPECT_EQ(Step(false), 0);
  EXPECT_TRUE(tracks_.all().empty());
}

TEST_F(TentativeTracksTest, WhatDoesNotCountIsForgottenAtOnce) {
  EXPECT_EQ(Step(true, /*counts=*/false), 0);
  EXPECT_TRUE(tracks_.all().empty());
}

TEST_F(TentativeTracksTest, WhatIsConfirmedIsGoneAtTheEndOfTheFrame) {
  Step(true);
  const int index = tracks_.Record(0, frame_, mask_, {}, true);
  tracks_.Confirm(index);
  tracks_.EndFrame(frame_);
  EXPECT_TRUE(tracks_.all().empty());
}

TEST(Appearance, IsTheMeanOfAllPixelsAtTheLastPlace) {
  const Frame frame = LayeredScene().Add({20, 30, 30, 60}, 2.0, 1).MakeFrame(0);
  const PointMap points = ComputePointMap(frame.depth, SceneCamera());
  Rigid3d pose = Rigid3d::Identity();
  pose.translation().x() = 1;
  const cv::Rect body(20, 30, 30, 60);
  Appearance appearance =
      ComputeAppearance(frame.color, points, RectMask(body), pose);
  EXPECT_NEAR(appearance.center.z(), 2, 0.01);
  EXPECT_NEAR(appearance.center.x(), 1 + (35.0 - 80) / 140 * 2, 0.02);
  const Appearance strip = ComputeAppearance(
      frame.color, points, RectMask({100, 30, 3, 60}), pose);  // Of the wall.
  EXPECT_EQ(ColorSimilarity(appearance, strip), 0);
  AddView(strip, &appearance);
  EXPECT_NEAR(ColorSimilarity(appearance, strip), 1.0 / 11, 1e-6);
  EXPECT_EQ(appearance.center, strip.center);
}

class ContactTest : public testing::Test {
 protected:
  double Share(double left_depth, double right_depth) const {
    LayeredScene scene;
    scene.Add(left_, left_depth, 1).Add(right_, right_depth, 2);
    const Frame frame = scene.MakeFrame(0);
    return ContactShare(ComputePointMap(frame.depth, SceneCamera()),
                        RectMask(left_), RectMask(right_));
  }
  const cv::Rect left_{40, 30, 30, 60};
  const cv::Rect right_{70, 30, 30, 60};
};

TEST_F(ContactTest, IsTheSharedSideOfOneSurface) {
  EXPECT_NEAR(Share(2.0, 2.0), 60.0 / 176, 0.05);
}

TEST_F(ContactTest, IsZeroAcrossADepthGap) {
  EXPECT_EQ(Share(2.0, 2.4), 0.0);
  EXPECT_EQ(Share(2.4, 2.0), 0.0);
}

}  // namespace
}  // namespace splitfusion
