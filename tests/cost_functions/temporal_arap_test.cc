#include "splitfusion/cost_functions/temporal_arap.h"

#include <gtest/gtest.h>

#include "support/sample_graphs.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kTemporalArap{"temporal_arap", /*weight=*/3,
                                LossKind::kTrivial, 0.01};

double TemporalArapEnergy(const DeformationGraph& graph,
                          const std::vector<NodeMotion>* before,
                          double anneal) {
  return EnergyOf(
      graph, ResidualsOf(TemporalArapTerm(),
                         {graph, {}, PinholeCamera(), nullptr, before, anneal},
                         kTemporalArap)
                 .residuals);
}

TEST(TemporalArapTerm, IsEquationSixWithTheEdgesOfTheFrameBefore) {
  constexpr double kAnneal = 5;
  DeformationGraph before = PlateGraph();
  Shake(0.05, /*seed=*/5, &before);
  DeformationGraph graph = before;
  Shake(0.01, /*seed=*/8, &graph);
  double sum = 0;
  int edges = 0;
  const auto along = [](const DeformationGraph& g, int i, int j) {
    const Eigen::Vector3d edge = g.positions[i] + g.motions[i].translation -
                                 g.positions[j] - g.motions[j].translation;
    return edge;
  };
  for (int i = 0; i < graph.size(); ++i) {
    const Eigen::Matrix3d turn =
        graph.motions[i].rotation * before.motions[i].rotation.transpose();
    for (const int j : graph.neighbors[i]) {
      sum += (along(graph, i, j) - turn * along(before, i, j)).squaredNorm();
      ++edges;
    }
  }
  const double expected = (kAnneal - 1) * 3.0 / edges * sum / (0.01 * 0.01);
  EXPECT_NEAR(TemporalArapEnergy(graph, &before.motions, kAnneal), expected,
              1e-9 * expected);
}

TEST(TemporalArapTerm, ABendThatMovesAlongCostsNothing) {
  DeformationGraph before = PlateGraph();
  Shake(0.2, /*seed=*/5, &before);
  DeformationGraph moved = before;
  ApplyRigidMotion(MakeMotion({0.4, -1.2, 0.3}, {1, 2, -3}), &moved);
  EXPECT_NEAR(TemporalArapEnergy(moved, &before.motions, 8), 0, 1e-9);
}

TEST(TemporalArapTerm, IsGoneWithoutAnnealingAndWithoutAFrameBefore) {
  DeformationGraph graph = PlateGraph();
  const std::vector<NodeMotion> before = graph.motions;
  Shake(0.2, /*seed=*/7, &graph);
  EXPECT_EQ(TemporalArapEnergy(graph, &before, 1), 0);
  EXPECT_EQ(TemporalArapEnergy(graph, nullptr, 8), 0);
  EXPECT_GT(TemporalArapEnergy(graph, &before, 8), 0);
  const DeformationGraph rigid = MakeRigidGraph(Rigid3d::Identity());
  EXPECT_EQ(TemporalArapEnergy(rigid, &rigid.motions, 8), 0);
}

}  // namespace
}  // namespace splitfusion
