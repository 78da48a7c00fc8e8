#include "splitfusion/lib/deformation/graph_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "support/expect_input_error.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Distance of a point to the nearest node other than `skipped`.
double NearestDistance(const DeformationGraph& graph, const Eigen::Vector3d& p,
                       int skipped = -1) {
  double best = 1e9;
  for (int i = 0; i < graph.size(); ++i) {
    if (i != skipped) best = std::min(best, (graph.positions[i] - p).norm());
  }
  return best;
}

/// The left part of a plate that is 0.4 m wide.
TriangleMesh PartOfPlate(double width) {
  return PlateMesh(width, 0.2, 0.01, 1);
}

TEST(GraphGrowth, NodesCoverTheSurfaceEvenly) {
  const TriangleMesh mesh = PartOfPlate(0.4);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_LT(NearestDistance(graph, v.cast<double>()), 0.04 + 1e-6);
  }
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_GE(NearestDistance(graph, graph.positions[i], i), 0.04 - 1e-6);
  }
  for (const NodeMotion& motion : graph.motions) {
    EXPECT_EQ(motion.rotation, Eigen::Matrix3d::Identity());
    EXPECT_EQ(motion.translation, Eigen::Vector3d(0, 0, 0));
  }
}

TEST(GraphGrowth, ACoveredSurfaceGetsNoNode) {
  const TriangleMesh mesh = PartOfPlate(0.4);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const auto neighbors = graph.neighbors;
  EXPECT_EQ(GrowGraph(mesh, GraphOptions(), &graph, nullptr), 0);
  EXPECT_EQ(graph.neighbors, neighbors);
}

TEST(GraphGrowth, OldNodesStayAsTheyAre) {
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  Shake(0.1, /*seed=*/1, &graph);
  const DeformationGraph before = graph;
  const int added =
      GrowGraph(PartOfPlate(0.4), GraphOptions(), &graph, nullptr);
  ASSERT_GT(added, 5);
  ASSERT_EQ(graph.size(), before.size() + added);
  for (int i = 0; i < before.size(); ++i) {
    EXPECT_EQ(graph.positions[i], before.positions[i]);
    EXPECT_EQ(graph.motions[i].rotation, before.motions[i].rotation);
    EXPECT_EQ(graph.motions[i].translation, before.motions[i].translation);
  }
}

TEST(GraphGrowth, NewNodesMoveWithTheRestInEveryFrame) {
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  const Rigid3d earlier = MakeMotion({0.1, 0.2, 0.3}, {0.3, 0, 0});
  const Rigid3d now = MakeMotion({-0.4, 0.1, 0}, {0, 0.5, 0.1});
  MotionLog history;
  DeformationGraph moved = graph;
  ApplyRigidMotion(earlier, &moved);
  history.Append(
      {4, true, moved.motions, std::vector<char>(moved.size(), true)});
  ApplyRigidMotion(now, &graph);
  ASSERT_GT(GrowGraph(PartOfPlate(0.4), GraphOptions(), &graph, &history), 0);
  const FrameMotions then = history.At(0);
  ASSERT_EQ(then.motions.size(), graph.motions.size());
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_EQ(then.Saw(i), i < moved.size()) << "not seen then";
    const Eigen::Vector3d& g = graph.positions[i];
    const Eigen::Vector3d p = g + Eigen::Vector3d(0.01, -0.01, 0.02);
    EXPECT_LT((ApplyNode(g, graph.motions[i], p) - now * p).norm(), 1e-5);
    EXPECT_LT((ApplyNode(g, then.motions[i], p) - earlier * p).norm(), 1e-5);
  }
}

TEST(GraphGrowth, NewNodesTakeTheBlendOfTheOldOnes) {
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  Shake(0.05, /*seed=*/8, &graph);
  const DeformationGraph before = graph;
  const SkinningIndex index(before, 6);
  const WarpField warp(before);
  GrowGraph(PartOfPlate(0.3), GraphOptions(), &graph, nullptr);
  for (int i = before.size(); i < graph.size(); ++i) {
    const Eigen::Vector3f g = graph.positions[i].cast<float>();
    const Eigen::Vector3d blended =
        warp.WarpPoint(index.Skin(g), g).cast<double>();
    EXPECT_LT(
        (graph.positions[i] + graph.motions[i].translation - blended).norm(),
        1e-6);
  }
}

TEST(GraphGrowth, TheCapHoldsByWiderSpacing) {
  const TriangleMesh mesh = PartOfPlate(0.4);
  GraphOptions options;
  options.max_nodes = 30;
  DeformationGraph graph;
  graph.node_spacing = 0.02;
  GrowGraph(mesh, options, &graph, nullptr);
  EXPECT_LE(graph.size(), 30);
  EXPECT_GT(graph.size(), 15);
  EXPECT_GT(graph.node_spacing, 0.02);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_LT(NearestDistance(graph, v.cast<double>()),
              graph.node_spacing + 1e-6);
  }
}

TEST(GraphGrowth, AFullGraphGrowsNoMore) {
  GraphOptions options;
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  options.max_nodes = graph.size();
  const int before = graph.size();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(GrowGraph(PartOfPlate(0.4), options, &graph, nullptr), 0);
  }
  EXPECT_EQ(graph.size(), before);
  EXPECT_EQ(graph.neighbors.size(), graph.positions.size());
  EXPECT_EQ(graph.node_spacing, 0.04);
}

TEST(GraphGrowth, ABatchThatWaitsLeavesTheSpacing) {
  GraphOptions options;
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  options.max_nodes = graph.size() + 40;
  options.growth_batch = 1;
  EXPECT_EQ(GrowGraph(PartOfPlate(0.22), options, &graph, nullptr), 0);
  EXPECT_EQ(graph.node_spacing, 0.04);
}

TEST(GraphGrowth, TheLastNodesThatThereIsRoomForDoNotWait) {
  GraphOptions options;
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.2), 0.04);
  options.max_nodes = graph.size() + 1;
  options.growth_batch = 1;
  EXPECT_EQ(GrowGraph(PartOfPlate(0.4), options, &graph, nullptr), 1);
  EXPECT_EQ(graph.size(), options.max_nodes);
  EXPECT_GT(graph.node_spacing, 0.04);
}

/// A graph over a plate, and what becomes of it when its mesh is another one.
struct Update {
  Update(const TriangleMesh& mesh, const GraphOptions& options)
      : graph(CoverWithNodes(PartOfPlate(0.4), 0.04)) {
    Shake(0.02, /*seed=*/5, &graph);
    graph.first_seen.resize(graph.size());
    std::iota(graph.first_seen.begin(), graph.first_seen.end(), 100);
    history.Append({3, true, graph.motions});
    before = graph;
    const SkinningIndex index(graph, 6);
    GraphRecord record{0.04, std::vector<char>(graph.size(), true)};
    change =
        UpdateGraph(mesh, options, index, MeshSkinning(index, mesh.vertices),
                    &graph, &record, &history);
  }

  DeformationGraph before, graph;
  MotionLog history;
  NodeChange change;
};

TEST(GraphUpdate, ForgetsNodesThatCarryNothing) {
  const Update update(PartOfPlate(0.2), GraphOptions());
  EXPECT_EQ(update.change.added, 0);
  ASSERT_GT(update.change.forgotten(), 10);
  const DeformationGraph& graph = update.graph;
  ASSERT_EQ(graph.size(), update.before.size() - update.change.forgotten());
  ASSERT_EQ(graph.neighbors.size(), graph.positions.size());
  double right_end = 0;
  for (int i = 0; i < graph.size(); ++i) {
    const int old = update.change.kept[i];
    EXPECT_EQ(graph.positions[i], update.before.positions[old]);
    EXPECT_EQ(graph.motions[i].translation,
              update.before.motions[old].translation);
    EXPECT_EQ(graph.first_seen[i], 100 + old);
    EXPECT_EQ(update.history.At(0).motions[i].translation,
              update.before.motions[old].translation);
    for (const int j : graph.neighbors[i]) EXPECT_LT(j, graph.size());
    right_end = std::max(right_end, graph.positions[i].x());
  }
  EXPECT_EQ(update.history.At(0).motions.size(), graph.motions.size());
  // Nodes beside the end carry the last vertices, too.
  EXPECT_LT(right_end, 0.2 + 3 * 0.04);
}

TEST(GraphUpdate, NodesThatHaveNotCarriedAVertexYetStay) {
  const TriangleMesh mesh = PartOfPlate(0.2);
  DeformationGraph graph = CoverWithNodes(PartOfPlate(0.4), 0.04);
  const DeformationGraph before = graph;
  GraphRecord record{0.04, {}};
  const auto update = [&](const TriangleMesh& now) {
    const SkinningIndex index(graph, 6);
    return UpdateGraph(now, GraphOptions(), index,
                       MeshSkinning(index, now.vertices), &graph, &record,
                       nullptr);
  };
  EXPECT_TRUE(update(mesh).none());
  EXPECT_EQ(graph.positions, before.positions);
  EXPECT_TRUE(update(PartOfPlate(0.4)).none());
  EXPECT_GT(update(mesh).forgotten(), 10);
  EXPECT_EQ(static_cast<int>(record.carried.size()), graph.size());
}

TEST(GraphUpdate, WhatMovesOnUnderTheLimitKeepsItsSpacing) {
  GraphOptions options;
  TriangleMesh mesh = PartOfPlate(0.4);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const int start = graph.size();
  options.max_nodes = start;
  GraphRecord record{0.04, std::vector<char>(start, true)};
  for (int step = 0; step < 30; ++step) {
    for (Eigen::Vector3f& v : mesh.vertices) v.x() += 0.02f;
    const SkinningIndex index(graph, 6);
    UpdateGraph(mesh, options, index, MeshSkinning(index, mesh.vertices),
                &graph, &record, nullptr);
    ASSERT_LE(graph.size(), options.max_nodes);
  }
  EXPECT_GT(graph.size(), 0.9 * start);
}

TEST(GraphUpdate, AddsAndForgetsAtOnce) {
  TriangleMesh mesh = PartOfPlate(0.4);
  for (Eigen::Vector3f& v : mesh.vertices) v.x() += 0.2f;
  const Update update(mesh, GraphOptions());
  ASSERT_GT(update.change.added, 10);
  ASSERT_GT(update.change.forgotten(), 10);
  ASSERT_EQ(update.graph.size(),
            static_cast<int>(update.change.kept.size()) + update.change.added);
  EXPECT_EQ(update.graph.first_seen.size(), update.change.kept.size());
  EXPECT_EQ(update.history.At(0).motions.size(), update.graph.motions.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_LT(NearestDistance(update.graph, v.cast<double>()), 0.04 + 1e-6);
  }
}

TEST(GraphUpdate, WhatIsForgottenMakesRoom) {
  GraphOptions options;
  TriangleMesh mesh = PartOfPlate(0.4);
  for (Eigen::Vector3f& v : mesh.vertices) v.x() += 0.2f;
  options.max_nodes = CoverWithNodes(PartOfPlate(0.4), 0.04).size();
  const Update update(mesh, options);
  EXPECT_GT(update.change.added, 10);
  EXPECT_LE(update.graph.size(), options.max_nodes);
}

TEST(GraphUpdate, ABatchWaitsForNodesThatGo) {
  GraphOptions options;
  options.growth_batch = 0.9;
  const Update update(PartOfPlate(0.2), options);
  EXPECT_TRUE(update.change.none());
  EXPECT_EQ(update.graph.positions, update.before.positions);
}

TEST(GraphUpdate, WithoutAMeshAllNodesStay) {
  const Update update{TriangleMesh(), GraphOptions()};
  EXPECT_TRUE(update.change.none());
  EXPECT_EQ(update.graph.size(), update.before.size());
}

TEST(GraphGrowth, SpecksWithoutATriangleGetNoNode) {
  TriangleMesh mesh = PartOfPlate(0.2);
  mesh.vertices.emplace_back(5.f, 5.f, 5.f);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  for (const Eigen::Vector3d& g : graph.positions) EXPECT_LT(g.x(), 1);
}

TEST(GraphGrowth, SpacingGrowsLinearlyWithDepth) {
  GraphOptions options;
  options.near_spacing = 0.02, options.far_spacing = 0.06;
  options.near_depth = 1, options.far_depth = 3;
  EXPECT_DOUBLE_EQ(NodeSpacing(options, 0.3), 0.02);
  EXPECT_DOUBLE_EQ(NodeSpacing(options, 2), 0.04);
  EXPECT_DOUBLE_EQ(NodeSpacing(options, 9), 0.06);
}

TEST(GraphOptions, RefuseValuesOutOfRange) {
  const auto refused = [](auto set, const std::string& message) {
    GraphOptions options;
    set(&options);
    ExpectInputError([&] { options.Check(); }, message);
  };
  refused([](GraphOptions* o) { o->neighbors_per_point = 9; },
          "neighbors_per_point = 9: expected 1..8");
  refused([](GraphOptions* o) { o->neighbors_per_node = 0; },
          "neighbors_per_node = 0: expected 1..64");
  refused([](GraphOptions* o) { o->near_spacing = 0.001; },
          "near_spacing = 0.001: expected metres >= 0.002");
  refused([](GraphOptions* o) { o->far_spacing = 0.01; },
          "far_spacing = 0.01: expected metres >= near_spacing");
  refused([](GraphOptions* o) { o->far_depth = o->near_depth; }, "far_depth");
  refused([](GraphOptions* o) { o->near_depth = 0; }, "near_depth = 0");
  refused([](GraphOptions* o) { o->max_nodes = 0; },
          "max_nodes = 0: expected nodes >= 1");
}

}  // namespace
}  // namespace splitfusion
