#include "splitfusion/lib/energy/block_problem.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

namespace splitfusion {
namespace {

/// Parts of the assembly; fixed, so that sums do not depend on threads.
constexpr int kParts = 4;

}  // namespace

BlockProblem::BlockProblem(const SurfaceProblem& problem,
                           const DeformationGraph& graph)
    : terms_(CollectBlocks(problem, graph)), nodes_(graph.size()) {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    for (const ResidualBlock& block : terms_[t].blocks) {
      EvaluatedBlock evaluated{&block, static_cast<int>(t), 0, {}, {}};
      const int rows = block.cost->num_residuals();
      evaluated.residuals.resize(rows);
      evaluated.jacobians.assign(block.nodes.size(), Jacobian(rows, 6));
      residual_count_ += rows;
      blocks_.push_back(std::move(evaluated));
    }
  }
}

bool BlockProblem::Evaluate(const std::vector<double>& twists,
                            bool with_jacobians) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size(), 64),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        EvaluateBlock(twists, with_jacobians, &blocks_[i]);
                      }
                    });
  return std::isfinite(Cost());
}

double BlockProblem::Cost() const {
  double sum = 0;
  for (const EvaluatedBlock& block : blocks_) sum += block.cost;
  return sum;
}

std::vector<double> BlockProblem::TermCosts() const {
  std::vector<double> costs(terms_.size(), 0.0);
  for (const EvaluatedBlock& block : blocks_) costs[block.term] += block.cost;
  return costs;
}

SymmetricBlockMatrix BlockProblem::MakeMatrix() const {
  std::vector<std::pair<int, int>> pairs;
  for (const EvaluatedBlock& block : blocks_) {
    const std::vector<int>& nodes = block.block->nodes;
    for (const int a : nodes) {
      for (const int b : nodes) {
        if (a < b) pairs.emplace_back(a, b);
      }
    }
  }
  return SymmetricBlockMatrix(nodes_, std::move(pairs));
}

void BlockProblem::Assemble(SymmetricBlockMatrix* matrix,
                            std::vector<Vector6>* gradient) const {
  std::vector<std::vector<Block6>> blocks(
      kParts, std::vector<Block6>(matrix->block_count(), Block6::Zero()));
  std::vector<std::vector<Vector6>> gradients(
      kParts, std::vector<Vector6>(nodes_, Vector6::Zero()));
  tbb::parallel_for(0, kParts, [&](int part) {
    const std::size_t begin = blocks_.size() * part / kParts;
    const std::size_t end = blocks_.size() * (part + 1) / kParts;
    for (std::size_t i = begin; i < end; ++i) {
      Accumulate(blocks_[i], *matrix, &blocks[part], &gradients[part]);
    }
  });
  for (std::size_t k = 0; k < matrix->block_count(); ++k) {
    Block6& sum = matrix->blocks()[k];
    sum = blocks[0][k];
    for (int part = 1; part < kParts; ++part) sum += blocks[part][k];
  }
  gradient->assign(nodes_, Vector6::Zero());
  for (int i = 0; i < nodes_; ++i) {
    for (int part = 0; part < kParts; ++part) {
      (*gradient)[i] += gradients[part][i];
    }
  }
}

void BlockProblem::EvaluateBlock(const std::vector<double>& twists,
                                 bool with_jacobians, EvaluatedBlock* out) {
  const ResidualBlock& block = *out->block;
  std::vector<const double*> parameters;
  std::vector<double*> jacobians;
  for (std::size_t k = 0; k < block.nodes.size(); ++k) {
    parameters.push_back(&twists[kTwistSize * block.nodes[k]]);
    jacobians.push_back(out->jacobians[k].data());
  }
  if (!block.cost->Evaluate(parameters.data(), out->residuals.data(),
                            with_jacobians ? jacobians.data() : nullptr)) {
    out->cost = std::nan("");
    return;
  }
  const double squared = out->residuals.squaredNorm();
  out->cost = 0.5 * squared;
  if (block.loss == nullptr) return;
  // Ceres' corrector for rho'' <= 0: residual and Jacobian by sqrt(rho').
  double rho[3];
  block.loss->Evaluate(squared, rho);
  out->cost = 0.5 * rho[0];
  const double root = std::sqrt(rho[1]);
  out->residuals *= root;
  for (Jacobian& jacobian : out->jacobians) {
    if (with_jacobians) jacobian *= root;
  }
}

void BlockProblem::Accumulate(const EvaluatedBlock& block,
                              const SymmetricBlockMatrix& matrix,
                              std::vector<Block6>* blocks,
                              std::vector<Vector6>* gradient) {
  const std::vector<int>& nodes = block.block->nodes;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const Jacobian& ja = block.jacobians[a];
    (*gradient)[nodes[a]].noalias() += ja.transpose() * block.residuals;
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      if (nodes[b] < nodes[a]) continue;
      (*blocks)[matrix.Index(nodes[a], nodes[b])].noalias() +=
          ja.transpose().lazyProduct(block.jacobians[b]);
    }
  }
}

}  // namespace splitfusion
