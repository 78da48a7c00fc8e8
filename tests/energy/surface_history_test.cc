#include "splitfusion/lib/energy/surface_history.h"

#include <gtest/gtest.h>

#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

/// Where a camera that moves along x by a metre a frame was, and a plate that
/// moves along y by a metre a frame; in frame 3 all are where they are.
class SurfaceHistoryTest : public ::testing::Test {
 protected:
  SurfaceHistoryTest() {
    for (int frame = 0; frame < 3; ++frame) {
      room_.Append({frame, true, At(frame, 0)});
      motions_.Append({frame, frame != 1, GraphAt(frame, frame).motions});
    }
    room_graph_.motions = At(3, 0);
  }

  /// Motions of a world that stands still, seen from camera `frame`.
  static std::vector<NodeMotion> At(int frame, double y) {
    return MakeRigidGraph(MakeMotion({0, 0, 0}, {-1.0 * frame, y, 0})).motions;
  }

  /// The plate at `y` seen from camera `frame`.
  static DeformationGraph GraphAt(int frame, double y) {
    DeformationGraph graph = PlateGraph();
    Shake(0.01, /*seed=*/1, &graph);
    ApplyRigidMotion(MakeMotion({0, 0, 0}, {-1.0 * frame, y, 0}), &graph);
    return graph;
  }

  static void ExpectAt(const std::vector<NodeMotion>& motions,
                       const DeformationGraph& graph) {
    ASSERT_EQ(motions.size(), graph.motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      EXPECT_TRUE(motions[i].rotation.isApprox(graph.motions[i].rotation));
      EXPECT_TRUE(
          motions[i].translation.isApprox(graph.motions[i].translation));
    }
  }

  MotionLog room_;
  DeformationGraph room_graph_ = MakeRigidGraph(Rigid3d::Identity());
  DeformationGraph graph_ = GraphAt(3, 3);
  MotionLog motions_;
  const SurfaceHistory history_{{graph_, motions_},
                                SurfaceHistory::Past{room_graph_, room_}};
};

TEST_F(SurfaceHistoryTest, IsAsTheLiveCameraWouldSeeIt) {
  EXPECT_EQ(history_.size(), 3);
  ASSERT_TRUE(history_.Find(2).has_value());
  EXPECT_EQ(history_.Find(2)->frame, 1);
  EXPECT_FALSE(history_.Find(2)->tracked);
  ExpectAt(history_.Before(1), GraphAt(3, 2));
  ExpectAt(history_.Before(3), GraphAt(3, 0));
}

TEST_F(SurfaceHistoryTest, OfTheBackgroundIsAsItsCamerasSawIt) {
  const SurfaceHistory history({room_graph_, room_});
  ASSERT_EQ(history.Before(2).size(), 1u);
  EXPECT_TRUE(
      history.Before(2)[0].translation.isApprox(Eigen::Vector3d(-1, 0, 0)));
}

TEST_F(SurfaceHistoryTest, OfRigidRoundsIsOneMotionFromTheStart) {
  const DeformationGraph start = GraphAt(3, 2.5);
  const std::vector<NodeMotion> back = history_.InRigidRounds(start).Before(1);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_TRUE(back[0].translation.isApprox(Eigen::Vector3d(0, -0.5, 0), 1e-9));
  EXPECT_TRUE(back[0].rotation.isIdentity(1e-9));
}

TEST_F(SurfaceHistoryTest, WhatIsNotKnownIsEmpty) {
  for (const int back : {-1, 0, 4}) {
    EXPECT_FALSE(history_.Find(back).has_value()) << back;
    EXPECT_TRUE(history_.Before(back).empty()) << back;
  }
  room_ = MotionLog();
  for (int frame = 1; frame < 3; ++frame) {
    room_.Append({frame, true, At(frame, 0)});
  }
  EXPECT_TRUE(history_.Before(3).empty()) << "where the camera was";
  EXPECT_TRUE(history_.Find(3).has_value());
  graph_.positions.pop_back();
  EXPECT_TRUE(history_.Before(1).empty()) << "of another graph";
}

}  // namespace
}  // namespace splitfusion
