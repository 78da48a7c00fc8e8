#include "splitfusion/lib/visibility/seen_edges.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/deformation/graph_growth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A plate of which every frame has other motions.
class SeenEdges : public ::testing::Test {
 protected:
  void AddFrames(int count) {
    for (int i = 0; i < count; ++i) {
      const int frame = static_cast<int>(history_.frames.size());
      Shake(0.1, /*seed=*/frame + 1, &graph_);
      history_.frames.push_back({frame, true, graph_.motions});
    }
    last_seen_.assign(graph_.size(),
                      static_cast<int>(history_.frames.size()) - 1);
  }

  Eigen::Vector3d Rest(int i, int j) const {
    return graph_.positions[i] - graph_.positions[j];
  }

  /// How node i of a frame sees the way from its neighbour j.
  Eigen::Vector3d InFrame(int frame, int i, int j) const {
    const std::vector<NodeMotion>& motions = history_.frames[frame].motions;
    return motions[i].rotation.inverse() *
           (Rest(i, j) + motions[i].translation - motions[j].translation);
  }

  DeformationGraph graph_ = CoverWithNodes(PlateMesh(0.2, 0.1, 0.01, 1), 0.04);
  MotionHistory history_;
  std::vector<int> last_seen_;
};

TEST_F(SeenEdges, AreThoseOfTheLastFrameWhereAllIsSeen) {
  AddFrames(3);
  KeepSeenEdges(history_, last_seen_, &graph_);
  ASSERT_EQ(graph_.seen_edges.size(), graph_.neighbors.size());
  for (int i = 0; i < graph_.size(); ++i) {
    ASSERT_EQ(graph_.seen_edges[i].size(), graph_.neighbors[i].size());
    for (std::size_t k = 0; k < graph_.neighbors[i].size(); ++k) {
      const Eigen::Vector3d now = InFrame(2, i, graph_.neighbors[i][k]);
      EXPECT_LT((graph_.seen_edges[i][k] - now).norm(), 1e-12);
    }
  }
}

TEST_F(SeenEdges, AreOfWhenBothEndsWereSeen) {
  AddFrames(8);
  last_seen_[0] = 4;
  const int j = graph_.neighbors[0][0];
  last_seen_[j] = 1;
  KeepSeenEdges(history_, last_seen_, &graph_);
  EXPECT_LT((graph_.seen_edges[0][0] - InFrame(1, 0, j)).norm(), 1e-12);
  // The other nodes are seen: the way to them is as old as the sight of 0.
  const int other = graph_.neighbors[0][1];
  EXPECT_LT((graph_.seen_edges[0][1] - InFrame(4, 0, other)).norm(), 1e-12);
}

TEST_F(SeenEdges, DoNotHangOnACommonMotion) {
  AddFrames(5);
  last_seen_.assign(graph_.size(), 2);
  KeepSeenEdges(history_, last_seen_, &graph_);
  const auto before = graph_.seen_edges;
  graph_.motions = history_.frames[2].motions;
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &graph_);
  history_.frames[2].motions = graph_.motions;
  KeepSeenEdges(history_, last_seen_, &graph_);
  for (int i = 0; i < graph_.size(); ++i) {
    for (std::size_t k = 0; k < before[i].size(); ++k) {
      EXPECT_LT((graph_.seen_edges[i][k] - before[i][k]).norm(), 1e-12);
    }
  }
}

TEST_F(SeenEdges, AreForgottenWhereTheGraphGrows) {
  AddFrames(1);
  KeepSeenEdges(history_, last_seen_, &graph_);
  EXPECT_GT(GrowGraph(PlateMesh(0.4, 0.1, 0.01, 1), GraphOptions(), &graph_,
                      &history_),
            0);
  EXPECT_TRUE(graph_.seen_edges.empty());
}

}  // namespace
}  // namespace splitfusion
