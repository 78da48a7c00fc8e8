#include "splitfusion/lib/evaluation/trajectory_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// A path that bends and turns; 30 Hz.
Trajectory Path(int poses) {
  Trajectory path;
  for (int i = 0; i < poses; ++i) {
    const double s = 0.1 * i;
    Rigid3d pose(Eigen::Translation3d(s, std::sin(s), 0.2 * s * s) *
                 Eigen::AngleAxisd(0.1 * s, Eigen::Vector3d::UnitX()));
    path.push_back({i / 30.0, pose});
  }
  return path;
}

TEST(CompareTrajectories, RigidMotionOfTheWorldIsNoError) {
  const Trajectory truth = Path(40);
  const Rigid3d motion(Eigen::Translation3d(1, -2, 3) *
                       Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()));
  Trajectory estimate = truth;
  for (TimedPose& pose : estimate) {
    pose.world_from_camera = motion.inverse() * pose.world_from_camera;
  }
  const TrajectoryError error = CompareTrajectories(estimate, truth);
  EXPECT_EQ(error.matched, 40);
  EXPECT_LT(error.absolute.max, 1e-12);
  EXPECT_TRUE(error.truth_from_estimate.isApprox(motion, 1e-9));
  EXPECT_TRUE(error.truth_from_estimate_by_poses.isApprox(motion, 1e-9));
  ASSERT_EQ(error.relative.size(), 2u);
  EXPECT_LT(error.relative[1].translation.max, 1e-12);
  EXPECT_LT(error.relative[1].rotation_degrees.max, 1e-5);
}

TEST(CompareTrajectories, SaddleOfASquareCannotBeAligned) {
  Trajectory truth;
  Trajectory estimate;
  const double e = 0.01;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d corner(i % 3 == 0 ? 1 : -1, i < 2 ? 1 : -1, 0);
    TimedPose pose;
    pose.timestamp = i;
    pose.world_from_camera.translation() = corner;
    truth.push_back(pose);
    pose.world_from_camera.translation().z() = i % 2 == 0 ? e : -e;
    estimate.push_back(pose);
  }
  const ErrorStatistics ate = CompareTrajectories(estimate, truth).absolute;
  EXPECT_NEAR(ate.rmse, e, 1e-12);
  EXPECT_NEAR(ate.median, e, 1e-12);
  EXPECT_NEAR(ate.max, e, 1e-12);
}

TEST(CompareTrajectories, AlignmentByPosesHoldsOnAStraightPath) {
  // About a straight line positions say nothing of the rotation; 1 mm to the
  // side over a path of 0.1 m turns the world by half a degree.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 11; ++i) {
    TimedPose pose;
    pose.timestamp = i;
    pose.world_from_camera.translation() = Eigen::Vector3d(0.01 * i, 0, 0);
    truth.push_back(pose);
    pose.world_from_camera.translation().y() = 1e-4 * i;
    estimate.push_back(pose);
  }
  const TrajectoryError error = CompareTrajectories(estimate, truth);
  EXPECT_GT(RotationAngle(error.truth_from_estimate.linear()), 0.009);
  const Rigid3d& alignment = error.truth_from_estimate_by_poses;
  EXPECT_LT(RotationAngle(alignment.linear()), 1e-9);
  EXPECT_NEAR(alignment.translation().y(), -5e-4, 1e-9);
}

TEST(CompareTrajectories, DriftShowsInTheRelativeError) {
  const Trajectory truth = Path(50);
  Trajectory estimate = truth;
  // The estimate turns by one degree and moves 2 mm more a frame.
  const Rigid3d step(Eigen::AngleAxisd(M_PI / 180, Eigen::Vector3d::UnitX()) *
                     Eigen::Translation3d(0.002, 0, 0));
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    const Rigid3d motion =
        truth[i - 1].world_from_camera.inverse() * truth[i].world_from_camera;
    estimate[i].world_from_camera =
        estimate[i - 1].world_from_camera * motion * step;
  }
  const TrajectoryError error = CompareTrajectories(estimate, truth);
  EXPECT_EQ(error.relative[0].frames, 1);
  EXPECT_NEAR(error.relative[0].translation.rmse, 0.002, 1e-9);
  EXPECT_NEAR(error.relative[0].rotation_degrees.mean, 1, 1e-9);
  EXPECT_EQ(error.relative[1].frames, 30);
  EXPECT_NEAR(error.relative[1].rotation_degrees.median, 30, 1e-6);
  EXPECT_EQ(error.relative[1].translation.count, 20);
}

TEST(CompareTrajectories, OrderOfLinesDoesNotMatter) {
  const Trajectory truth = Path(20);
  Trajectory shuffled = truth;
  std::reverse(shuffled.begin(), shuffled.end());
  EXPECT_LT(CompareTrajectories(shuffled, truth).absolute.max, 1e-12);
}

TEST(CompareTrajectories, SaysHowManyPosesMatch) {
  Trajectory late = Path(10);
  for (TimedPose& pose : late) pose.timestamp += 8.1 / 30;
  try {
    CompareTrajectories(late, Path(10));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("2 of 10 estimated poses match one of the 10 true "
                          "poses within 0.02 s: expected at least 3"));
  }
}

Trajectory At(const std::vector<double>& times) {
  Trajectory trajectory;
  for (const double t : times) trajectory.push_back({t, Rigid3d::Identity()});
  return trajectory;
}

TEST(MatchPoses, IsNearestAndOneToOne) {
  EXPECT_THAT(MatchPoses(At({0.000, 0.008, 0.019, 0.5}),
                         At({0.001, 0.010, 0.052}), 0.02),
              ElementsAre(Pair(0, 0), Pair(1, 1)));
  EXPECT_THAT(MatchPoses(At({1, 2}), At({}), 0.02), ElementsAre());
}

}  // namespace
}  // namespace splitfusion
