#include "splitfusion/lib/tracking/key_frames.h"

#include <gtest/gtest.h>

#include "tracking/printed_plate.h"

namespace splitfusion {
namespace {

/// The plate is the world, and nothing else is certain.
LiveView ViewOfWorld(const Rigid3d& camera_from_world, bool is_printed = true) {
  LiveView live = ViewOfPlate(camera_from_world, is_printed);
  live.uncertain.setTo(255, live.labels == 0);
  live.labels.setTo(0);
  return live;
}

void ExpectNear(const Rigid3d& found, const Rigid3d& expected) {
  const Rigid3d off = found.inverse() * expected;
  EXPECT_LT(off.translation().norm(), 0.015);
  EXPECT_LT(RotationAngle(off.linear()), 0.06);
}

TEST(KeyFrames, FindACameraThatWentAway) {
  const Rigid3d first = PoseOfPlate(-0.3, -0.2), last = PoseOfPlate(0.9, 0.3);
  KeyFrames frames{KeyFrameOptions()};
  frames.Keep(ViewOfWorld(first), first);
  frames.Keep(ViewOfWorld(last), last);
  for (const Rigid3d& now : {PoseOfPlate(-0.15, 0), PoseOfPlate(0.8, 0.2)}) {
    const std::vector<Rigid3d> places = frames.Find(ViewOfWorld(now));
    ASSERT_FALSE(places.empty());
    ExpectNear(places.front(), now);
  }
}

TEST(KeyFrames, FindNothingWithoutTextureOrFrames) {
  const Rigid3d pose = PoseOfPlate(0, 0);
  KeyFrames frames{KeyFrameOptions()};
  EXPECT_TRUE(frames.Find(ViewOfWorld(pose)).empty());
  frames.Keep(ViewOfWorld(pose, false), pose);
  EXPECT_TRUE(frames.Find(ViewOfWorld(pose, false)).empty());
}

TEST(KeyFrames, AreOfWhatNoOtherShows) {
  KeyFrames frames{KeyFrameOptions()};
  const Rigid3d pose = PoseOfPlate(0, 0);
  for (int i = 0; i < 3; ++i) frames.Keep(ViewOfWorld(pose), pose);
  EXPECT_EQ(frames.size(), 1);
  // Half of the plate is out of view from here, so that from the first place
  // all is seen that is seen here.
  const Rigid3d near = PoseOfPlate(0, 0.78);
  frames.Keep(ViewOfWorld(near), near);
  EXPECT_EQ(frames.size(), 1);
  // And back: more is seen than was.
  KeyFrames others{KeyFrameOptions()};
  others.Keep(ViewOfWorld(near), near);
  others.Keep(ViewOfWorld(pose), pose);
  EXPECT_EQ(others.size(), 2);
}

TEST(KeyFrames, AreNoneWithoutOverlap) {
  KeyFrameOptions options;
  options.overlap = 0;
  KeyFrames frames(options);
  const Rigid3d pose = PoseOfPlate(0, 0);
  frames.Keep(ViewOfWorld(pose), pose);
  EXPECT_EQ(frames.size(), 0);
  EXPECT_TRUE(frames.Find(ViewOfWorld(pose)).empty());
}

TEST(KeyFrames, OnThePathAreTurnsAndEndsOfWhatIsTracked) {
  KeyFrames frames{KeyFrameOptions()};
  const auto keep = [&](int frame, double x, bool goes_on = true) {
    const Rigid3d pose = PoseOfPlate(0, x);
    const LiveView live = ViewOfWorld(pose);
    frames.KeepOnPath(live, pose, frame, goes_on);
    frames.Keep(live, pose);
  };
  // One half of the plate, the other, and back: no new key frame, but another
  // one on the path.
  keep(0, 0.78);
  keep(1, -0.78);
  keep(2, 0.78);
  keep(3, 0.77);
  // Lost, and found in the same place.
  keep(4, 0.76);
  keep(7, 0.76, /*goes_on=*/false);
  keep(8, 0.77);
  const std::vector<PathFrame> path = frames.Path(kSightCamera);
  std::vector<int> indices;
  std::vector<bool> go_on;
  for (const PathFrame& frame : path) {
    indices.push_back(frame.frame);
    go_on.push_back(frame.goes_on);
    EXPECT_FALSE(frame.view.landmarks.points.empty());
    EXPECT_GT(frame.points.norm(), 1);
  }
  EXPECT_EQ(indices, (std::vector<int>{0, 1, 2, 4, 7, 8}));
  EXPECT_EQ(go_on, (std::vector<bool>{false, true, true, true, false, true}));
  EXPECT_EQ(frames.size(), 2);
}

}  // namespace
}  // namespace splitfusion
