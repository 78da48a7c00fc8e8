#include "splitfusion/lib/tracking/last_sights.h"

#include <gtest/gtest.h>

#include "tracking/printed_plate.h"

namespace splitfusion {
namespace {

TEST(LastSights, KnowASurfaceAgainThatTurnedAndWentAway) {
  const Rigid3d before = PoseOfPlate(-0.2, -0.2), now = PoseOfPlate(0.35, 0.2);
  LastSights sights;
  sights.Keep(1, ViewOfPlate(before), before);
  const Rigid3d predicted = MakeMotion({0, 0, 0}, {0.05, 0, 0}) * before;
  const auto motion =
      sights.FindMotion(1, ViewOfPlate(now), predicted, /*ratio=*/0.85);
  ASSERT_TRUE(motion);
  const Rigid3d off = (*motion * predicted).inverse() * now;
  EXPECT_LT(off.translation().norm(), 0.015);
  EXPECT_LT(RotationAngle(off.linear()), 0.06);
}

TEST(LastSights, KnowNothingWithoutTexture) {
  const Rigid3d before = PoseOfPlate(-0.2, -0.2), now = PoseOfPlate(0.3, 0.2);
  LastSights sights;
  sights.Keep(1, ViewOfPlate(before, false), before);
  EXPECT_FALSE(sights.FindMotion(1, ViewOfPlate(now, false), before, 0.85));
}

TEST(LastSights, AreOfOneSurfaceUntilItIsForgotten) {
  const Rigid3d pose = PoseOfPlate(0, 0);
  const LiveView live = ViewOfPlate(pose);
  LastSights sights;
  EXPECT_FALSE(sights.FindMotion(1, live, pose, 0.85));
  sights.Keep(1, live, pose);
  EXPECT_TRUE(sights.FindMotion(1, live, pose, 0.85));
  EXPECT_FALSE(sights.FindMotion(2, live, pose, 0.85));
  // Of what is nowhere in view the sight before stays.
  LiveView empty = live;
  empty.labels = empty.labels.clone();
  empty.labels.setTo(0);
  sights.Keep(1, empty, pose);
  EXPECT_TRUE(sights.FindMotion(1, live, pose, 0.85));
  EXPECT_FALSE(sights.FindMotion(1, empty, pose, 0.85));
  sights.Forget(1);
  EXPECT_FALSE(sights.FindMotion(1, live, pose, 0.85));
}

}  // namespace
}  // namespace splitfusion
