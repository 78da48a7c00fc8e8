#include "splitfusion/pipelines/loop_closure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tracking/printed_plate.h"

namespace splitfusion {
namespace {

constexpr int kPathFrames = 21;
constexpr double kReach = 0.05;

/// Where a frame was tracked that is somewhere else, camera from plate.
using Drift = std::function<Rigid3d(int frame, const Rigid3d& truth)>;

/// A camera that goes along the plate and comes back.
Rigid3d TruePose(int frame) {
  const int there = std::min(frame, kPathFrames - 1 - frame);
  return PoseOfPlate(0.02 * there, 0.05 * there);
}

LoopClosure Close(const Drift& drift, int lost_before = -1) {
  KeyFrames frames{KeyFrameOptions()};
  std::map<int, Rigid3d> tracked;
  for (int i = 0; i < kPathFrames; ++i) {
    LiveView live = ViewOfPlate(TruePose(i));
    live.uncertain.setTo(255, live.labels == 0);
    live.labels.setTo(0);
    const Rigid3d pose = drift(i, TruePose(i));
    frames.KeepOnPath(live, pose, i, i != lost_before);
    frames.Keep(live, pose);
    tracked[i] = pose.inverse();
  }
  return CloseLoops(frames.Path(kSightCamera), tracked, kSightCamera.noise,
                    KeyFrameOptions(), kReach);
}

/// Largest distance of the plate from where a camera saw it, metres.
double LargestError(const LoopClosure& closure) {
  double largest = 0;
  for (const auto& [frame, pose] : closure.world_from_camera) {
    const Rigid3d off = TruePose(frame) * pose;
    const Eigen::Vector3d plate(0, 0, 1.2);
    largest = std::max(largest, (off * plate - plate).norm());
  }
  return largest;
}

TEST(LoopClosure, LeavesAPathWithoutDriftWhereItIs) {
  const LoopClosure closure =
      Close([](int, const Rigid3d& truth) { return truth; });
  EXPECT_EQ(closure.world_from_camera.size(), std::size_t{kPathFrames});
  EXPECT_LT(closure.report.largest_change, 0.01);
  EXPECT_LT(LargestError(closure), 0.01);
}

TEST(LoopClosure, TakesDriftOutOfEveryFrame) {
  const LoopClosure closure = Close([](int frame, const Rigid3d& truth) {
    return Rigid3d(Eigen::Translation3d(0, 0.006 * frame, 0)) * truth;
  });
  const LoopReport& report = closure.report;
  EXPECT_GE(report.key_frames, 4);
  EXPECT_GE(report.found, report.key_frames);
  EXPECT_GT(report.misfit_before, 0.03);
  EXPECT_LT(report.misfit_after, 0.02);
  EXPECT_GT(report.largest_change, 0.05);
  EXPECT_LT(LargestError(closure), 0.04);
}

TEST(LoopClosure, BelievesLandmarksWhereTheCameraWasLost) {
  const LoopClosure closure = Close(
      [](int frame, const Rigid3d& truth) {
        return frame < 8 ? truth
                         : Rigid3d(Eigen::Translation3d(0, 0.2, 0)) * truth;
      },
      /*lost_before=*/8);
  EXPECT_NEAR(closure.report.largest_shift, 0.2, 0.02);
  EXPECT_LT(LargestError(closure), 0.02);
}

TEST(LoopClosure, OfNoPathIsNothing) {
  const LoopClosure closure = CloseLoops({}, {}, DepthNoise(), {}, kReach);
  EXPECT_EQ(closure.report.key_frames, 0);
  EXPECT_TRUE(closure.world_from_camera.empty());
}

}  // namespace
}  // namespace splitfusion
