// A ball in the corner of a room, mapped as background: whether it is seen to
// move on its own.

#include "splitfusion/pipelines/own_motion.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "splitfusion/pipelines/standing_objects.h"

namespace splitfusion {
namespace {

constexpr double kGrazing = 1.3;  // Radians.
const Eigen::Vector3d kPlace(0.05, 0, 0.95);

cv::Mat_<float> Ball(const Eigen::Vector3d& place) {
  return SphereDepth(Camera(), place, 0.15);
}

/// The ball, and the corner behind it, with the noise of the sensor.
cv::Mat_<float> Scene(const Eigen::Vector3d& place, int seed) {
  cv::Mat_<float> depth = CornerDepth(Rigid3d::Identity());
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
    cv::Mat_<float> depth = CornerDepth(Rigid3d::Identity());
    Ball(kPlace).copyTo(depth, Ball(kPlace) > 0);
    return SamplesOf(View(depth));
  }();
  cv::Mat_<uchar> mask_ = Ball(kPlace) > 0;
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
  EXPECT_LT((motion.camera_from_canonical * kPlace - kPlace - way).norm(),
            0.003);
}

TEST_F(OwnMotionTest, TakesNothingFromPixelsOfOtherSurfaces) {
  LiveView live = View(Scene(kPlace - Eigen::Vector3d(0, 0, 0.02), 1));
  live.labels.setTo(1, mask_);
  const OwnMotion motion = Find(live);
  EXPECT_EQ(motion.gain, 0);
}

PipelineOptions StandingOptions() {
  PipelineOptions options;
  options.split.max_missed_frames = 3;
  return options;
}

class StandingObjectsTest : public OwnMotionTest {
 protected:
  /// How many are found to move in the next frame.
  std::size_t CountMoving(bool detected, const Eigen::Vector3d& place) {
    std::vector<StandingObject> detections;
    if (detected) detections.push_back({mask_, "chair", 0.9, {}});
    LiveView live = View(Scene(place, ++frame_));
    if (hidden_) live.labels.setTo(1, mask_);
    moving_ = objects_.Watch(detections, mapped_, live,
                             MakeRigidGraph(Rigid3d::Identity()), {});
    return moving_.size();
  }
  const Eigen::Vector3d moved_ = kPlace - Eigen::Vector3d(0, 0, 0.015);
  StandingObjects objects_{StandingOptions()};
  std::vector<StandingObjects::Moving> moving_;
  bool hidden_ = false;  // By another surface.
  int frame_ = 0;
};

TEST_F(StandingObjectsTest, MoveOnceAndAreNotStandingAnyMore) {
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, moved_), 1u);
  EXPECT_EQ(CountMoving(false, moved_), 0u);
}

TEST_F(StandingObjectsTest, MoveSlowlyInTwoFramesOrNotAtAll) {
  // As little as noise alone explains once in thousands of frames.
  const Eigen::Vector3d slightly = kPlace - Eigen::Vector3d(0, 0, 0.0035);
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, slightly), 0u);
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, slightly), 0u);
  EXPECT_EQ(CountMoving(true, slightly), 1u);
}

TEST_F(StandingObjectsTest, BeginToMoveByNoMoreThanTheWayOfAFrame) {
  const Eigen::Vector3d jump = kPlace - Eigen::Vector3d(0, 0, 0.08);
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(false, jump), 0u);
  EXPECT_EQ(CountMoving(false, moved_), 1u);
}

TEST_F(StandingObjectsTest, AreNotWhatWasNeverMappedWhereItIsSeen) {
  const Eigen::Vector3d elsewhere = kPlace - Eigen::Vector3d(0, 0, 0.3);
  EXPECT_EQ(CountMoving(true, elsewhere), 0u);
  EXPECT_EQ(CountMoving(false, moved_), 0u);
}

TEST_F(StandingObjectsTest, HaveNothingOfWhatIsBesideThemInALooseMask) {
  const std::size_t of_ball = SamplesWithin(mask_, mapped_).size();
  cv::dilate(Ball(kPlace) > 0, mask_, cv::Mat::ones(13, 13, CV_8U));
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  ASSERT_EQ(CountMoving(true, moved_), 1u);
  EXPECT_GT(moving_[0].points.size(), 0.9 * of_ball);
  std::size_t beside = 0;
  for (const Eigen::Vector3f& point : moving_[0].points) {
    beside += (point.cast<double>() - kPlace).norm() > 0.16;
  }
  EXPECT_LT(beside, 0.02 * of_ball);
}

TEST_F(StandingObjectsTest, ArePartsOfWhatIsDetectedWhole) {
  const cv::Mat_<uchar> whole = mask_.clone();
  const cv::Rect box = cv::boundingRect(whole);
  mask_(cv::Rect(box.x, box.y, box.width, 6 * box.height / 10)) = 0;
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  mask_ = whole;
  EXPECT_EQ(CountMoving(true, kPlace), 0u);
  EXPECT_EQ(CountMoving(true, moved_), 1u);  // Not the part, too.
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
