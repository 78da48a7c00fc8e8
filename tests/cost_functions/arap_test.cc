#include "splitfusion/cost_functions/arap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/gradient_check.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

DeformationGraph SampleGraph() {
  return CoverWithNodes(PlateMesh(0.2, 0.1, 0.01, 1), 0.04);
}

Eigen::Vector3d Value(const Arap& arap,
                      const std::vector<std::vector<double>>& twists) {
  const double* const blocks[2] = {twists[0].data(), twists[1].data()};
  Eigen::Vector3d residual;
  arap(blocks, residual.data());
  return residual;
}

const std::vector<std::vector<double>> kNoTwists(2, std::vector<double>(6, 0));

TEST(Arap, ValueByHand) {
  DeformationGraph graph;
  graph.positions = {{1, 0, 0}, {0, 0, 0}};
  graph.motions.resize(2);
  graph.motions[0].rotation = ExpSo3({0, 0, M_PI / 2});
  graph.motions[0].translation = {0, 0, 3};
  graph.motions[1].translation = {5, 0, 0};
  // (1, 0, 3) - (5, 0, 0) - R (1, 0, 0) = (-4, 0, 3) - (0, 1, 0).
  const Eigen::Vector3d r = Value(Arap::Make(graph, 0, 1), kNoTwists);
  EXPECT_LT((r - Eigen::Vector3d(-4, -1, 3)).norm(), 1e-12);
}

TEST(Arap, WeightOfTheEdgeIsOutsideOfTheNorm) {
  DeformationGraph graph = SampleGraph();
  Shake(0.1, /*seed=*/1, &graph);
  Arap arap = Arap::Make(graph, 0, 1);
  const Eigen::Vector3d plain = Value(arap, kNoTwists);
  arap.sqrt_weight = 3;
  EXPECT_LT((Value(arap, kNoTwists) - 3 * plain).norm(), 1e-12);
}

TEST(Arap, IsZeroUnderCommonRigidMotion) {
  DeformationGraph graph = SampleGraph();
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &graph);
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      EXPECT_LT(Value(Arap::Make(graph, i, j), kNoTwists).norm(), 1e-12);
    }
  }
}

TEST(Arap, LengthDoesNotChangeWhenEverythingMovesAlong) {
  DeformationGraph graph = SampleGraph();
  Shake(0.2, /*seed=*/2, &graph);
  DeformationGraph moved = graph;
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &moved);
  for (const int j : graph.neighbors[0]) {
    EXPECT_NEAR(Value(Arap::Make(moved, 0, j), kNoTwists).norm(),
                Value(Arap::Make(graph, 0, j), kNoTwists).norm(), 1e-12);
  }
}

TEST(Arap, TwistsAreIncrementsOfTheMotions) {
  DeformationGraph graph = SampleGraph();
  Shake(0.2, /*seed=*/3, &graph);
  const auto twists = RandomTwists(2, 0.5, /*seed=*/4);
  const Eigen::Vector3d before = Value(Arap::Make(graph, 0, 1), twists);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Map<const Eigen::Vector3d> omega(twists[i].data());
    const Eigen::Map<const Eigen::Vector3d> tau(twists[i].data() + 3);
    graph.motions[i].rotation = ExpSo3(omega) * graph.motions[i].rotation;
    graph.motions[i].translation += tau;
  }
  EXPECT_LT((Value(Arap::Make(graph, 0, 1), kNoTwists) - before).norm(), 1e-12);
}

TEST(Arap, RotationOfTheFirstNodeCountsThatOfTheSecondDoesNot) {
  const DeformationGraph graph = SampleGraph();
  auto twists = kNoTwists;
  twists[1] = {0.5, 0.5, 0.5, 0, 0, 0};
  EXPECT_LT(Value(Arap::Make(graph, 0, 1), twists).norm(), 1e-12);
  std::swap(twists[0], twists[1]);
  EXPECT_GT(Value(Arap::Make(graph, 0, 1), twists).norm(), 1e-3);
}

TEST(Arap, GradientsMatchNumeric) {
  DeformationGraph graph = SampleGraph();
  Shake(0.3, /*seed=*/5, &graph);
  const auto cost = AutoDiffOverTwists(Arap::Make(graph, 0, 1), 2, 3);
  for (const double size : {0.0, 1e-6, 0.01, 1.0}) {
    EXPECT_GRADIENTS_MATCH(*cost, RandomTwists(2, size, /*seed=*/7));
  }
}

TEST(ArapTerm, SumsOverAllDirectedEdges) {
  DeformationGraph graph = SampleGraph();
  Shake(0.01, /*seed=*/6, &graph);
  const TermOptions options{"arap", /*weight=*/3, LossKind::kTrivial, 0.01};
  const AddedResiduals added =
      ResidualsOf(ArapTerm(), {graph, {}, PinholeCamera()}, options);
  int edges = 0;
  double sum = 0;
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      ++edges;
      sum += Value(Arap::Make(graph, i, j), kNoTwists).squaredNorm();
    }
  }
  EXPECT_EQ(added.residual_vectors, edges);
  const double cost = EnergyOf(graph, added.residuals);
  EXPECT_NEAR(cost, 3.0 / edges * sum / (0.01 * 0.01), 1e-9 * cost);
  EXPECT_TRUE(ArapTerm().is_prior());
}

/// The energy of one edge that `anneal` asks for, written down: the prior, and
/// the rest of its weight on the edge of the frame before.
double AnnealedEnergy(const DeformationGraph& graph,
                      const DeformationGraph& before, double anneal) {
  const Eigen::Vector3d r = Value(Arap::Make(graph, 0, 1), kNoTwists);
  const Eigen::Matrix3d turn =
      graph.motions[0].rotation * before.motions[0].rotation.transpose();
  const auto along = [](const DeformationGraph& g) -> Eigen::Vector3d {
    return g.positions[0] + g.motions[0].translation - g.positions[1] -
           g.motions[1].translation;
  };
  return r.squaredNorm() +
         (anneal - 1) * (along(graph) - turn * along(before)).squaredNorm();
}

TEST(Arap, AnnealingHoldsTheBendOfTheFrameBefore) {
  constexpr double kAnneal = 5;
  DeformationGraph before = SampleGraph();
  Shake(0.2, /*seed=*/5, &before);
  const auto held = [&](const DeformationGraph& graph) {
    Arap arap = Arap::Make(graph, 0, 1);
    arap.HoldBend(graph, before.motions, kAnneal, 0, 1);
    return kAnneal * Value(arap, kNoTwists).squaredNorm();
  };
  // Equal but for a constant, wherever the nodes are.
  const double constant =
      AnnealedEnergy(before, before, kAnneal) - held(before);
  for (int seed = 6; seed < 16; ++seed) {
    DeformationGraph moved = before;
    Shake(0.2, seed, &moved);
    ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &moved);
    EXPECT_NEAR(AnnealedEnergy(moved, before, kAnneal), held(moved) + constant,
                1e-12);
  }
}

TEST(Arap, WithoutAnnealingTheFrameBeforeIsNoMatter) {
  DeformationGraph graph = SampleGraph();
  const std::vector<NodeMotion> before = graph.motions;
  Shake(0.2, /*seed=*/7, &graph);
  Arap arap = Arap::Make(graph, 0, 1);
  arap.HoldBend(graph, before, /*anneal=*/1, 0, 1);
  EXPECT_EQ(arap.edge, Arap::Make(graph, 0, 1).edge);
}

TEST(ArapTerm, IsAnnealedAboutTheFrameBefore) {
  constexpr double kAnneal = 5;
  DeformationGraph before = SampleGraph();
  Shake(0.05, /*seed=*/5, &before);
  DeformationGraph graph = before;
  Shake(0.01, /*seed=*/8, &graph);
  const TermOptions options{"arap", /*weight=*/3, LossKind::kTrivial, 0.01};
  const AddedResiduals added = ResidualsOf(
      ArapTerm(),
      {graph, {}, PinholeCamera(), nullptr, &before.motions, kAnneal}, options);
  double sum = 0;
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      Arap arap = Arap::Make(graph, i, j);
      arap.HoldBend(graph, before.motions, kAnneal, i, j);
      sum += Value(arap, kNoTwists).squaredNorm();
    }
  }
  const double cost = EnergyOf(graph, added.residuals);
  EXPECT_NEAR(cost, 3.0 / added.residual_vectors * sum / (0.01 * 0.01),
              1e-9 * cost);
}

/// A graph whose edges were last seen as another one's are.
struct BentAndShaken {
  BentAndShaken() {
    Shake(0.05, /*seed=*/5, &bent);
    graph.seen_edges.resize(graph.size());
    for (int i = 0; i < graph.size(); ++i) {
      for (const int j : graph.neighbors[i]) {
        graph.seen_edges[i].push_back(
            bent.motions[i].rotation.transpose() *
            (bent.positions[i] + bent.motions[i].translation -
             bent.positions[j] - bent.motions[j].translation));
      }
    }
  }

  /// Energy at these motions if so many points hang on every node.
  double Energy(const std::vector<NodeMotion>& motions, int points) const {
    DeformationGraph moved = graph;
    moved.motions = motions;
    std::vector<Correspondence> correspondences;
    for (int i = 0; i < points * moved.size(); ++i) {
      Skinning& skinning = correspondences.emplace_back().model.skinning;
      skinning.count = 1;
      skinning.nodes[0] = i % moved.size();
      skinning.weights[0] = 1;
    }
    const TermOptions options{"arap", /*weight=*/3, LossKind::kTrivial, 0.01};
    return EnergyOf(
        moved, ResidualsOf(ArapTerm(),
                           {moved, correspondences, PinholeCamera()}, options)
                   .residuals);
  }

  DeformationGraph graph = SampleGraph();
  DeformationGraph bent = graph;
};

TEST(ArapTerm, HiddenEdgesHoldAPartOfTheShapeThatWasSeen) {
  BentAndShaken scene;
  EXPECT_LT(scene.Energy(scene.graph.motions, 10), 1e-12)
      << "seen, it is at rest at rest";
  const double seen = scene.Energy(scene.bent.motions, 10);
  EXPECT_GT(seen, 1);
  // Bent as it was seen, the residuals are those parts of the bend that do not
  // hold it; at rest, those that do.
  const double rest = 1 - ArapTerm::kHeld;
  EXPECT_NEAR(scene.Energy(scene.bent.motions, 0), rest * rest * seen,
              1e-9 * seen);
  EXPECT_GT(scene.Energy(scene.graph.motions, 0), 1);
}

/// Energy of one edge of 4 cm, last seen with 6 cm, if so many points hang on
/// its ends.
double EnergyOfLongEdge(int points_of_first, int points_of_second) {
  DeformationGraph graph;
  graph.positions = {{0, 0, 0}, {0.04, 0, 0}};
  graph.motions.resize(2);
  graph.neighbors = {{1}, {}};
  graph.seen_edges = {{{-0.06, 0, 0}}, {}};
  std::vector<Correspondence> correspondences(points_of_first +
                                              points_of_second);
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    Skinning& skinning = correspondences[i].model.skinning;
    skinning.count = 1;
    skinning.weights[0] = 1;
    skinning.nodes[0] = static_cast<int>(i) < points_of_first ? 0 : 1;
  }
  const TermOptions options{"arap", /*weight=*/1, LossKind::kTrivial, 0.01};
  return EnergyOf(
      graph, ResidualsOf(ArapTerm(), {graph, correspondences, PinholeCamera()},
                         options)
                 .residuals);
}

TEST(ArapTerm, AnEdgeIsAsHiddenAsItsHiddenEnd) {
  EXPECT_NEAR(EnergyOfLongEdge(4, 4), 0, 1e-12) << "both ends are seen";
  const double held = std::pow(2 * ArapTerm::kHeld, 2);
  EXPECT_NEAR(EnergyOfLongEdge(8, 0), held, 1e-9) << "a part of 2 cm too short";
  EXPECT_NEAR(EnergyOfLongEdge(0, 8), held, 1e-9);
  EXPECT_NEAR(EnergyOfLongEdge(2, 4), held / 4, 1e-9) << "half of that";
}

TEST(ArapTerm, EdgesOfAnotherGraphAreNotHeld) {
  BentAndShaken scene;
  scene.graph.seen_edges[0].pop_back();
  EXPECT_LT(scene.Energy(scene.graph.motions, 0), 1e-12);
}

TEST(ArapTerm, IsAbsentOnARigidSurface) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const AddedResiduals added =
      ResidualsOf(ArapTerm(), {graph, {}, PinholeCamera()}, TermOptions());
  EXPECT_EQ(added.residuals.of_nodes, nullptr);
  EXPECT_EQ(added.residual_vectors, 0);
}

}  // namespace
}  // namespace splitfusion
