#include "splitfusion/lib/energy/node_covariance.h"

#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/ceres_blocks.h"
#include "splitfusion/lib/energy/term_residuals.h"
#include "support/custom_energy.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Eq. 6, one residual of which was measured amiss.
class AmissArapTerm : public EnergyTerm {
 public:
  AmissArapTerm(int number, double shift) : number_(number), shift_(shift) {}

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<std::vector<int>> nodes;
    std::vector<Amiss> functors;
    for (int i = 0; i < input.graph.size(); ++i) {
      for (const int j : input.graph.neighbors[i]) {
        nodes.push_back({i, j});
        functors.push_back({Arap::Make(input.graph, i, j), {0, 0, 0}});
      }
    }
    if (number_ >= 0) functors[number_ / 3].shift[number_ % 3] = shift_;
    sink->AddNodes(nodes, functors);
  }

 private:
  struct Amiss {
    static constexpr int kResiduals = 3;
    Arap arap;
    Eigen::Vector3d shift;
    template <typename T>
    bool operator()(T const* const* twists, T* residual) const {
      arap(twists, residual);
      for (int d = 0; d < 3; ++d) residual[d] += T(shift[d]);
      return true;
    }
  };

  int number_;
  double shift_;
};

/// A covariance, its directions in units of the standard deviations that
/// `scale` has of them.
template <typename Matrix>
Matrix Normalized(const Matrix& covariance, const Matrix& scale) {
  const auto units = scale.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
  return units * covariance * units;
}

template <typename Matrix>
double Deviation(const Matrix& covariance, const Matrix& expected) {
  return (Normalized(covariance, expected) - Normalized(expected, expected))
      .cwiseAbs()
      .maxCoeff();
}

/// A corner that is bent, with pairs that do not quite agree.
class NodeCovarianceTest : public ::testing::Test {
 protected:
  NodeCovarianceTest() : mesh_(CornerMesh(0.05)) {
    graph_ = CoverWithNodes(mesh_, 0.1);
    pairs_ = PerfectAssociation(
        mesh_, graph_, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1); });
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      Correspondence& c = pairs_[i];
      c.target += 0.003F * std::sin(5.0F * i) * c.warped_normal;
      skinnings_.push_back(c.model.skinning);
    }
    options_.solver = "gn_cholesky";
    options_.max_iterations = 50;
    options_.function_tolerance = 1e-14;
    options_.initial_radius = 1e12;
  }

  void Solve(const Energy& energy, const std::vector<Correspondence>& pairs,
             DeformationGraph* graph) const {
    EXPECT_TRUE(Minimize({energy, pairs, camera_}, options_, graph).usable);
  }

  /// Twists of all nodes from graph_ to `moved`.
  Eigen::VectorXd TwistsTo(const DeformationGraph& moved) const {
    Eigen::VectorXd twists(6 * graph_.size());
    for (int i = 0; i < graph_.size(); ++i) {
      const Eigen::Matrix3d turn =
          moved.motions[i].rotation * graph_.motions[i].rotation.transpose();
      ceres::RotationMatrixToAngleAxis(turn.data(), &twists[6 * i]);
      twists.segment<3>(6 * i + 3) =
          moved.motions[i].translation - graph_.motions[i].translation;
    }
    return twists;
  }

  /// Where all model points are, one after the other.
  Eigen::VectorXd PointsUnder(const DeformationGraph& graph) const {
    Eigen::VectorXd points = Eigen::VectorXd::Zero(3 * pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const ModelSample& model = pairs_[i].model;
      for (int k = 0; k < model.skinning.count; ++k) {
        const int node = model.skinning.nodes[k];
        points.segment<3>(3 * i) +=
            model.skinning.weights[k] * ApplyNode(graph.positions[node],
                                                  graph.motions[node],
                                                  model.point.cast<double>());
      }
    }
    return points;
  }

  TriangleMesh mesh_;
  PinholeCamera camera_;
  DeformationGraph graph_;
  std::vector<Correspondence> pairs_;
  std::vector<Skinning> skinnings_;
  SolverOptions options_;
};

TEST_F(NodeCovarianceTest, IsThatOfCeres) {
  const Energy energy = EnergyWithCustomTerm();
  Solve(energy, pairs_, &graph_);
  const SurfaceProblem problem{energy, pairs_, camera_};
  std::vector<double> twists(6 * graph_.size(), 0.0);
  ceres::Problem ceres_problem;
  for (const ProblemTerm& term : CollectResiduals(problem, graph_)) {
    for (ResidualBlock& block : MakeCeresBlocks(graph_, term.residuals)) {
      std::vector<double*> parameters;
      for (const int node : block.nodes) {
        parameters.push_back(&twists[6 * node]);
      }
      ceres_problem.AddResidualBlock(block.cost.release(), nullptr, parameters);
    }
  }
  const NodeCovariance covariance(problem, graph_, skinnings_);
  ceres::Covariance expected((ceres::Covariance::Options()));
  std::vector<std::pair<const double*, const double*>> wanted;
  for (int i = 0; i < graph_.size(); ++i) {
    for (const int j : graph_.neighbors[i]) {
      wanted.emplace_back(&twists[6 * i], &twists[6 * j]);
    }
    wanted.emplace_back(&twists[6 * i], &twists[6 * i]);
  }
  ASSERT_TRUE(expected.Compute(wanted, &ceres_problem));
  const auto blocks_of = [&](int i, int j) {
    Block6 block;
    expected.GetCovarianceBlock(&twists[6 * i], &twists[6 * j], block.data());
    return Block6(block * covariance.unit_variance());
  };
  for (int i = 0; i < graph_.size(); ++i) {
    const Block6 own = blocks_of(i, i);
    EXPECT_LT(Deviation(covariance.Block(i, i), own), 1e-6) << i;
    for (const int j : graph_.neighbors[i]) {
      const double size = std::sqrt(own.norm() * blocks_of(j, j).norm());
      EXPECT_LT((covariance.Block(i, j) - blocks_of(i, j)).norm(), 1e-6 * size);
    }
  }
}

// Every measurement amiss by its own standard deviation, one after the other,
// and solved again: the sum of the squares of what that moves.
TEST_F(NodeCovarianceTest, IsWhatFinitePerturbationsOfAllMeasurementsMove) {
  Energy energy = ParseEnergy("point_to_plane arap(weight=8)", BuiltinTerms());
  Solve(energy, pairs_, &graph_);
  const NodeCovariance covariance({energy, pairs_, camera_}, graph_,
                                  skinnings_);
  const auto amiss_by = [&](std::size_t term, std::size_t vectors) {
    return kResidualUnit * std::sqrt(covariance.unit_variance() * vectors /
                                     (2 * energy[term].options.weight));
  };
  Eigen::MatrixXd nodes =
      Eigen::MatrixXd::Zero(6 * graph_.size(), 6 * graph_.size());
  Eigen::MatrixXd points =
      Eigen::MatrixXd::Zero(3 * pairs_.size(), 3 * pairs_.size());
  const auto add =
      [&](const std::function<void(double, DeformationGraph*)>& solve) {
        DeformationGraph more = graph_, less = graph_;
        solve(1, &more);
        solve(-1, &less);
        const Eigen::VectorXd node = (TwistsTo(more) - TwistsTo(less)) / 2;
        const Eigen::VectorXd point =
            (PointsUnder(more) - PointsUnder(less)) / 2;
        nodes += node * node.transpose();
        points += point * point.transpose();
      };
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    add([&](double sign, DeformationGraph* graph) {
      std::vector<Correspondence> amiss = pairs_;
      amiss[i].target += static_cast<float>(sign * amiss_by(0, pairs_.size())) *
                         pairs_[i].warped_normal;
      Solve(energy, amiss, graph);
    });
  }
  std::size_t edges = 0;
  for (const auto& neighbors : graph_.neighbors) edges += neighbors.size();
  for (std::size_t i = 0; i < 3 * edges; ++i) {
    add([&](double sign, DeformationGraph* graph) {
      Energy amiss = energy;
      amiss[1].term = std::make_shared<AmissArapTerm>(
          static_cast<int>(i), sign * amiss_by(1, edges));
      Solve(amiss, pairs_, graph);
    });
  }
  for (int i = 0; i < graph_.size(); ++i) {
    const Block6 moved = nodes.block<6, 6>(6 * i, 6 * i);
    EXPECT_LT(Deviation(covariance.Block(i, i), moved), 0.05) << "node " << i;
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const ModelSample& model = pairs_[i].model;
    const Eigen::Matrix3d moved = points.block<3, 3>(3 * i, 3 * i);
    EXPECT_LT(Deviation(covariance.OfPoint(model.skinning, model.point), moved),
              0.05)
        << "point " << i;
  }
}

TEST_F(NodeCovarianceTest, WhatNoPairTouchesIsHeldByThePriorAlone) {
  const Energy energy =
      ParseEnergy("point_to_plane arap(weight=8)", BuiltinTerms());
  // Those of one half.
  std::vector<Correspondence> half;
  std::vector<char> touched(graph_.size(), false);
  for (const Correspondence& c : pairs_) {
    if (c.model.point.x() > 0.1) continue;
    half.push_back(c);
    for (int k = 0; k < c.model.skinning.count; ++k) {
      touched[c.model.skinning.nodes[k]] = true;
    }
  }
  Solve(energy, half, &graph_);
  const NodeCovariance covariance({energy, half, camera_}, graph_, skinnings_);
  const NodeCovariance seen({energy, pairs_, camera_}, graph_, skinnings_);
  std::vector<int> expected;
  for (int i = 0; i < graph_.size(); ++i) {
    if (touched[i]) continue;
    expected.push_back(i);
    EXPECT_GT(covariance.Block(i, i).trace() / covariance.unit_variance(),
              seen.Block(i, i).trace() / seen.unit_variance());
  }
  ASSERT_FALSE(expected.empty());
  EXPECT_EQ(covariance.held_by_prior(), expected);
  EXPECT_TRUE(seen.held_by_prior().empty());
}

TEST_F(NodeCovarianceTest, WhatNothingHoldsIsKnownToAMetre) {
  const Energy energy =
      ParseEnergy("point_to_plane arap(weight=8)", BuiltinTerms());
  const int last = graph_.size() - 1;
  for (auto& neighbors : graph_.neighbors) neighbors.clear();
  std::vector<Correspondence> none;
  for (const Correspondence& c : pairs_) {
    const auto& nodes = c.model.skinning.nodes;
    const auto end = nodes.begin() + c.model.skinning.count;
    if (std::find(nodes.begin(), end, last) == end) none.push_back(c);
  }
  const NodeCovariance covariance({energy, none, camera_}, graph_, skinnings_);
  EXPECT_LT((covariance.Block(last, last) - Block6::Identity()).norm(), 1e-9);
  for (const Correspondence& c : pairs_) {
    EXPECT_TRUE(
        covariance.OfPoint(c.model.skinning, c.model.point).allFinite());
  }
}

}  // namespace
}  // namespace splitfusion
