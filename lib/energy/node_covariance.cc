#include "splitfusion/lib/energy/node_covariance.h"

#include <algorithm>
#include <array>
#include <utility>

#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {
namespace {

using NodePairs = std::vector<std::pair<int, int>>;

/// What a direction is known to at least: 1 / m^2 or 1 / rad^2.
constexpr double kLeastInformation = 1;  // Maths: guard of singular matrices.

/// Where nothing is left over there is still something to divide by.
constexpr double kLeastVariance = 1e-30;  // Maths: guard of division by 0.

/// sigma_0^2 of what is solved for by `parameters` numbers.
double UnitVariance(const BlockProblem& problem, int parameters) {
  const int redundancy = CountResiduals(problem.terms()) - parameters;
  return std::max(2 * problem.Cost() / std::max(1, redundancy), kLeastVariance);
}

/// All pairs of nodes that carry a point together, lower one first.
NodePairs PairsOf(const std::vector<Skinning>& points) {
  NodePairs pairs;
  for (const Skinning& point : points) {
    for (int k = 0; k < point.count; ++k) {
      for (int l = k + 1; l < point.count; ++l) {
        pairs.push_back(std::minmax(point.nodes[k], point.nodes[l]));
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// `matrix` / `divisor`, with room for blocks at `pairs`.
SymmetricBlockMatrix Information(const SymmetricBlockMatrix& matrix,
                                 double divisor, NodePairs pairs) {
  for (int i = 0; i < matrix.size(); ++i) {
    for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
      pairs.emplace_back(i, matrix.columns()[k]);
    }
  }
  SymmetricBlockMatrix information(matrix.size(), std::move(pairs));
  for (int i = 0; i < matrix.size(); ++i) {
    for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
      information.blocks()[information.Index(i, matrix.columns()[k])] =
          matrix.blocks()[k] / divisor;
    }
  }
  return information;
}

/// What a direction counts as known to, so that nothing is singular: at least
/// kLeastInformation, and so much that it is not lost beside what is known
/// best.
double LeastInformation(const SymmetricBlockMatrix& information) {
  constexpr double kPrecision = 1e-12;  // Maths: of a factorisation.
  double most = 0;
  for (const Block6& block : information.blocks()) {
    most = std::max(most, block.diagonal().maxCoeff());
  }
  return std::max(kLeastInformation, kPrecision * most);
}

/// Nodes that carry no point of any residual, ascending.
std::vector<int> NodesWithoutPoints(const std::vector<ProblemTerm>& terms,
                                    int nodes) {
  std::vector<char> touched(nodes, false);
  for (const ProblemTerm& term : terms) {
    if (term.residuals.points == nullptr) continue;
    for (const WarpedPoints::Group& group : term.residuals.points->groups()) {
      for (int k = 0; k < group.node_count; ++k) {
        touched[group.nodes[k]] = true;
      }
    }
  }
  std::vector<int> untouched;
  for (int i = 0; i < nodes; ++i) {
    if (!touched[i]) untouched.push_back(i);
  }
  return untouched;
}

/// Derivative of a warped point by the twist of one of the nodes that carry it.
Eigen::Matrix<double, 3, 6> ByTwist(const NodeTransport& node) {
  Eigen::Matrix<double, 3, 6> derivative;
  const Eigen::Vector3d& p = node.rotated;
  derivative << 0, p.z(), -p.y(), 1, 0, 0,  //
      -p.z(), 0, p.x(), 0, 1, 0,            //
      p.y(), -p.x(), 0, 0, 0, 1;
  return node.weight * derivative;
}

}  // namespace

NodeCovariance::NodeCovariance(const SurfaceProblem& problem,
                               const DeformationGraph& graph,
                               const std::vector<Skinning>& points)
    : graph_(graph) {
  BlockProblem blocks(problem, graph);
  blocks.Evaluate(blocks.Start(), /*with_jacobians=*/true);
  BorderedMatrix matrix = blocks.MakeMatrix();
  BorderedVector gradient;
  blocks.Assemble(&matrix, &gradient);
  unit_variance_ = UnitVariance(blocks, kTwistSize * graph.size());
  held_by_prior_ = NodesWithoutPoints(blocks.terms(), graph.size());
  const SymmetricBlockMatrix information =
      Information(matrix.nodes, unit_variance_, PairsOf(points));
  inverse_.emplace(information, LeastInformation(information));
}

Eigen::Matrix3d NodeCovariance::OfPoint(const Skinning& skinning,
                                        const Eigen::Vector3f& point) const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::array<Eigen::Matrix<double, 3, 6>, kMaxSkinningNodes> by_twist;
  for (int k = 0; k < skinning.count; ++k) {
    by_twist[k] = ByTwist(MakeTransport(
        graph_, skinning.nodes[k], skinning.weights[k], point.cast<double>()));
    const Eigen::Matrix3d own = by_twist[k] *
                                Block(skinning.nodes[k], skinning.nodes[k]) *
                                by_twist[k].transpose();
    covariance += own;
    for (int l = 0; l < k; ++l) {
      const Eigen::Matrix3d shared =
          by_twist[k] * Block(skinning.nodes[k], skinning.nodes[l]) *
          by_twist[l].transpose();
      covariance += shared + shared.transpose();
    }
  }
  return covariance;
}

}  // namespace splitfusion
