#include "splitfusion/lib/sequence/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

std::string ReadMessage(const std::string& path) {
  try {
    ReadTumTrajectory(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

/// On a circle, turned along it.
TimedPose OnCircle(double time) {
  const Eigen::AngleAxisd turn(time, Eigen::Vector3d::UnitY());
  Rigid3d pose(turn * Eigen::Translation3d(0.5, 0, 0));
  return {time, pose};
}

TEST(PoseAmid, GoesOnAsItCameAndWent) {
  const UnseenMotion motion{OnCircle(0), OnCircle(0.03), OnCircle(0.6),
                            OnCircle(0.63)};
  for (const double time : {0.1, 0.3, 0.5}) {
    const Rigid3d off =
        PoseAmid(motion, time).inverse() * OnCircle(time).world_from_camera;
    EXPECT_LT(off.translation().norm(), 0.004) << time;
    EXPECT_LT(RotationAngle(off.linear()), 0.001) << time;
  }
  EXPECT_TRUE(
      PoseAmid(motion, 0.6).isApprox(OnCircle(0.6).world_from_camera, 1e-9));
}

TEST(PoseAmid, GoesStraightWithoutVelocities) {
  const TimedPose from = OnCircle(0), to = OnCircle(1);
  const Rigid3d middle = PoseAmid({from, from, to, to}, 0.5);
  const Eigen::Vector3d straight = (from.world_from_camera.translation() +
                                    to.world_from_camera.translation()) /
                                   2;
  EXPECT_LT((middle.translation() - straight).norm(), 1e-9);
  EXPECT_NEAR(RotationAngle(middle.linear()), 0.5, 1e-9);
  // Of no time at all.
  EXPECT_TRUE(
      PoseAmid({from, from, from, from}, 0).isApprox(from.world_from_camera));
}

TEST(TumTrajectory, RoundTripKeepsNineDigits) {
  Trajectory trajectory;
  for (int i = 0; i < 4; ++i) {
    Rigid3d pose(Eigen::Translation3d(i, -1.0 / 3, 1e-7) *
                 Eigen::AngleAxisd(i, Eigen::Vector3d(1, 2, 3).normalized()));
    trajectory.push_back({1305031102.175304 + i / 30.0, pose});
  }
  const TemporaryFolder folder;
  WriteTumTrajectory(folder / "a.txt", trajectory);
  const Trajectory read = ReadTumTrajectory(folder / "a.txt");
  ASSERT_EQ(read.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(read[i].timestamp, trajectory[i].timestamp, 1e-6);
    EXPECT_TRUE(read[i].world_from_camera.isApprox(
        trajectory[i].world_from_camera, 1e-8));
  }
}

TEST(TumTrajectory, SkipsCommentsAndNormalisesQuaternions) {
  const TemporaryFolder folder;
  const Trajectory read = ReadTumTrajectory(
      folder.Write("a.txt", "# head\n\n  # indented\n1.5 1 2 3 0 0 2 2\n"));
  ASSERT_EQ(read.size(), 1u);
  const Eigen::Vector3d x =
      read[0].world_from_camera.linear() * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(x.isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST(TumTrajectory, NamesFileAndLineOfWhatIsWrong) {
  const TemporaryFolder folder;
  for (const auto* line :
       {"1 2 3", "1 2 3 4 0 0 0 0", "a b c d e f g h", "1 nan 3 4 0 0 0 1"}) {
    const std::string path =
        folder.Write("a.txt", std::string("0 0 0 0 0 0 0 1\n") + line + "\n");
    EXPECT_THAT(ReadMessage(path), HasSubstr("a.txt:2: expected 'timestamp"));
  }
  EXPECT_THAT(ReadMessage(folder / "none.txt"), HasSubstr("cannot be opened"));
}

TEST(TumTrajectory, LinesOneByOneMakeTheSameFile) {
  const TemporaryFolder folder;
  const Trajectory trajectory(2, {12.25, Rigid3d::Identity()});
  WriteTumTrajectory(folder / "a.txt", trajectory);
  std::ostringstream text;
  WriteTumHeader(text);
  for (const TimedPose& pose : trajectory) WriteTumPose(text, pose);
  EXPECT_EQ(folder.Read("a.txt"), text.str());
}

}  // namespace
}  // namespace splitfusion
