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
  DeformationGraph graph = PlateGraph();
  Shake(0.1, /*seed=*/1, &graph);
  Arap arap = Arap::Make(graph, 0, 1);
  const Eigen::Vector3d plain = Value(arap, kNoTwists);
  arap.sqrt_weight = 3;
  EXPECT_LT((Value(arap, kNoTwists) - 3 * plain).norm(), 1e-12);
}

TEST(Arap, IsZeroUnderCommonRigidMotion) {
  DeformationGraph graph = PlateGraph();
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &graph);
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      EXPECT_LT(Value(Arap::Make(graph, i, j), kNoTwists).norm(), 1e-12);
    }
  }
}

TEST(Arap, LengthDoesNotChangeWhenEverythingMovesAlong) {
  DeformationGraph graph = PlateGraph();
  Shake(0.2, /*seed=*/2, &graph);
  DeformationGraph moved = graph;
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &moved);
  for (const int j : graph.neighbors[0]) {
    EXPECT_NEAR(Value(Arap::Make(moved, 0, j), kNoTwists).norm(),
                Value(Arap::Make(graph, 0, j), kNoTwists).norm(), 1e-12);
  }
}

TEST(Arap, TwistsAreIncrementsOfTheMotions) {
  DeformationGraph graph = PlateGraph();
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
  const DeformationGraph graph = PlateGraph();
  auto twists = kNoTwists;
  twists[1] = {0.5, 0.5, 0.5, 0, 0, 0};
  EXPECT_LT(Value(Arap::Make(graph, 0, 1), twists).norm(), 1e-12);
  std::swap(twists[0], twists[1]);
  EXPECT_GT(Value(Arap::Make(graph, 0, 1), twists).norm(), 1e-3);
}

TEST(Arap, GradientsMatchNumeric) {
  DeformationGraph graph = PlateGraph();
  Shake(0.3, /*seed=*/5, &graph);
  const auto cost = AutoDiffOverTwists(Arap::Make(graph, 0, 1), 2, 3);
  for (const double size : {0.0, 1e-6, 0.01, 1.0}) {
    EXPECT_GRADIENTS_MATCH(*cost, RandomTwists(2, size, /*seed=*/7));
  }
}

TEST(ArapTerm, SumsOverAllDirectedEdges) {
  DeformationGraph graph = PlateGraph();
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
}

TEST(ArapTerm, IsEquationSixWhateverElseIsKnown) {
  DeformationGraph graph = PlateGraph();
  Shake(0.01, /*seed=*/6, &graph);
  const TermOptions options{"arap", /*weight=*/3, LossKind::kTrivial, 0.01};
  const auto energy = [&](const EnergyInput& input) {
    return EnergyOf(graph, ResidualsOf(ArapTerm(), input, options).residuals);
  };
  const double plain = energy({graph, {}, PinholeCamera()});
  DeformationGraph before = PlateGraph();
  Shake(0.05, /*seed=*/7, &before);
  EXPECT_EQ(energy({graph, {}, PinholeCamera(), nullptr, &before.motions, 8}),
            plain);
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
