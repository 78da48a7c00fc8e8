#include "splitfusion/pipelines/pose_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/pi.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

constexpr int kPoses = 24;
constexpr double kDistance = 0.06;

/// All about the camera.
TypicalPoints RoomPoints() {
  return TypicalPointsOf({{-2, -1, 0}, {2, 1, 0}, {0, 1, 2}, {0, -1, -2}});
}

/// A camera that turns about itself, once around and back to where it began.
std::vector<Rigid3d> TrueCircle() {
  std::vector<Rigid3d> poses;
  for (int i = 0; i < kPoses; ++i) {
    const double angle = 2 * kPi<double> * i / (kPoses - 1);
    poses.push_back(MakeMotion({0, angle, 0}, {0, 0, 0.3}));
  }
  return poses;
}

Rigid3d MotionBetween(const std::vector<Rigid3d>& poses, int from, int to) {
  return poses[to] * poses[from].inverse();
}

PoseEdge Loop(int from, int to, const Rigid3d& motion) {
  return {from, to, motion, RoomPoints(), /*may_be_wrong=*/true};
}

/// Tracked with a drift in every step: `poses` and the edges between.
struct DriftingChain {
  DriftingChain() {
    const std::vector<Rigid3d> truth = TrueCircle();
    const Rigid3d drift = MakeMotion({0, 0.008, 0.001}, {0.001, 0, 0});
    poses.push_back(truth[0]);
    for (int i = 1; i < kPoses; ++i) {
      const Rigid3d step = drift * MotionBetween(truth, i - 1, i);
      poses.push_back(step * poses.back());
      edges.push_back({i - 1, i, step, RoomPoints()});
    }
  }
  std::vector<Rigid3d> poses;
  std::vector<PoseEdge> edges;
};

/// Largest distance of what a pose shows from where it is, metres.
double LargestPoseError(const std::vector<Rigid3d>& poses) {
  const std::vector<Rigid3d> truth = TrueCircle();
  double largest = 0;
  for (int i = 0; i < kPoses; ++i) {
    const TypicalPoints off =
        poses[i].inverse() * RoomPoints() - truth[i].inverse() * RoomPoints();
    largest = std::max(largest, off.norm() / 2);
  }
  return largest;
}

TEST(PoseGraph, WithoutLoopsNothingMoves) {
  const DriftingChain chain;
  const auto solved = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  for (int i = 0; i < kPoses; ++i) {
    EXPECT_TRUE(solved[i].isApprox(chain.poses[i], 1e-9)) << i;
  }
}

TEST(PoseGraph, ALoopTakesTheDriftOutOfAllPoses) {
  DriftingChain chain;
  ASSERT_GT(LargestPoseError(chain.poses), 0.3);
  const Rigid3d closed = MotionBetween(TrueCircle(), 0, kPoses - 1);
  chain.edges.push_back(Loop(0, kPoses - 1, closed));
  const auto solved = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  EXPECT_TRUE(solved[0].isApprox(chain.poses[0], 0));
  EXPECT_LT(LargestPoseError(solved), 0.05);
  EXPECT_LT(Contradiction(solved, chain.edges.back()), 0.03);
}

TEST(PoseGraph, AFalseLoopFallsOut) {
  DriftingChain chain;
  const std::vector<Rigid3d> truth = TrueCircle();
  for (const auto& [from, to] : std::vector<std::pair<int, int>>{
           {0, kPoses - 1}, {1, kPoses - 1}, {0, kPoses - 2}}) {
    chain.edges.push_back(Loop(from, to, MotionBetween(truth, from, to)));
  }
  const auto without = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  // Two walls that look alike.
  chain.edges.push_back(Loop(3, 15, MakeMotion({0, 0.1, 0}, {0.2, 0, 0})));
  const auto solved = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  EXPECT_LT(LargestPoseError(solved), 0.05);
  EXPECT_GT(Contradiction(solved, chain.edges.back()), 1);
  for (int i = 0; i < kPoses; ++i) {
    EXPECT_TRUE(solved[i].isApprox(without[i], 1e-3)) << i;
  }
}

TEST(PoseGraph, IsTheSameEveryTime) {
  DriftingChain chain;
  chain.edges.push_back(
      Loop(0, kPoses - 1, MotionBetween(TrueCircle(), 0, kPoses - 1)));
  const auto once = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  const auto again = SolvePoseGraph(chain.poses, chain.edges, kDistance);
  for (int i = 0; i < kPoses; ++i) {
    EXPECT_EQ(once[i].matrix(), again[i].matrix());
  }
}

}  // namespace
}  // namespace splitfusion
