// A ball before a wall, mapped as background: whether it is seen to move on its
// own.

#include "splitfusion/pipelines/own_motion.h"

#include <gtest/gtest.h>

#include <vector>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/pipelines/standing_objects.h"

namespace splitfusion {
namespace {

constexpr double kGrazing = 1.3;  // Radians.
const Eigen::Vector3d kPlace(0.1, 0, 1.6);

cv::Mat_<float> Ball(const Eigen::Vector3d& place) {
  return SphereDepth(Camera(), place, 0.25);
}

/// The ball, and the wall that it stands before, with the noise of the sensor.
cv::Mat_<float> Scene(const Eigen::Vector3d& place, int seed) {
  cv::Mat_<float> depth = WallDepth(Camera(), 2.0);
  const cv::Mat_<float> ball = Ball(place);
  ball.copyTo(depth, ball > 0);
  cv::RNG random(seed);
  for (float& z : depth) {
    z += static_cast<float>(random.gaussian(Camera().noise.Sigma(z)));
  }
  return depth;
}

class OwnMotionTest : public testing::Test {
 protected:
  OwnMotion Find(const LiveView& live) const {
    return FindOwnMotion(SamplesWithin(mask_, mapped_), mask_, live,
                         MakeRigidGraph(Rigid3d::Identity()), MakeTracker(),
                         kGrazing);
  }
  // The map has no noise any more.
  const std::vector<ModelSample> mapped_ = [] {
    cv::Mat_<float> depth = WallDepth(Camera(), 2.0);
    Ball(kPlace).copyTo(depth, Ball(kPlace) > 0);
    return SamplesOf(View(depth));
  }();
  const cv::Mat_<uchar> mask_ = Ball(kPlace) > 0;
};

TEST_F(OwnMotionTest, IsNoneOfWhatStands) {
  for (int seed = 1; seed < 6; ++seed) {
    EXPECT_LT(Find(View(Scene(kPlace, seed))).gain, 0.1) << seed;
  }
}

TEST_F(OwnMotionTest, IsSeenLongBeforeAThingHasLeftItsPlace) {
  const Eigen::Vector3d way(0.01, 0, -0.01);
  const OwnMotion motion = Find(View(Scene(kPlace + way, 1)));
  EXPECT_GT(motion.gain, 1);
  EXPECT_GT(motion.points.size(), 0.9 * SamplesWithin(mask_, mapped_).size());
}

TEST_F(OwnMotionTest, TakesNothingFromPixelsOfOtherSurfaces) {
  LiveView live = View(Scene(kPlace - Eigen::Vector3d(0, 0, 0.02), 1));
  live.labels.setTo(1, mask_);
  const OwnMotion motion = Find(live);
  EXPECT_EQ(motion.gain, 0);
  EXPECT_TRUE(motion.points.empty());
}

class StandingObjectsTest : public OwnMotionTest {
 protected:
  /// How many are found to move in the next frame.
  std::size_t CountMoving(bool detected, const Eigen::Vector3d& place) {
    std::vector<StandingObject> detections;
    if (detected) detections.push_back({mask_, "chair", 0.9, {}});
    const Rigid3d still = Rigid3d::Identity();
    LiveView live = View(Scene(place, ++frame_));
    if (hidden_) live.labels.setTo(1, mask_);
    objects_.Detect(detections, /*max_missed=*/3, /*stride=*/2, live, still);
    return objects_
        .TakeMoving(mapped_, live, MakeRigidGraph(still), MakeTracker(),
                    kGrazing,
                    /*min_gain=*/0.5)
        .size();
  }
  const Eigen::Vector3d moved_ = kPlace - Eigen::Vector3d(0, 0, 0.015);
  StandingObjects objects_;
  bool hidden_ = false;  // By another surface.
  int frame_ = 0;
};

TEST_F(StandingObjectsTest, MoveOnceAndAreNotStandingAnyMore) {
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, moved_), 1u);
  EXPECT_EQ(CountMoving(false, moved_), 0u);
}

TEST_F(StandingObjectsTest, AreWatchedThroughMissedDetections) {
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(CountMoving(false, kPlace), 0u);
  EXPECT_EQ(CountMoving(false, moved_), 1u);
}

TEST_F(StandingObjectsTest, AreForgottenWithoutDetections) {
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(CountMoving(false, kPlace), 0u);
  EXPECT_EQ(CountMoving(false, moved_), 0u);
}

TEST_F(StandingObjectsTest, AreRememberedWhileTheyAreHidden) {
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  hidden_ = true;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(CountMoving(false, kPlace), 0u);
  hidden_ = false;
  EXPECT_EQ(CountMoving(false, moved_), 1u);
}

}  // namespace
}  // namespace splitfusion
