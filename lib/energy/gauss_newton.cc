#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_blocks.h"

namespace splitfusion {
namespace {

/// Bounds of the diagonal that damping is relative to, as in Ceres.
constexpr double kMinDiagonal = 1e-6;
constexpr double kMaxDiagonal = 1e32;
/// Parts of the assembly; fixed, so that sums do not depend on threads.
constexpr int kParts = 4;

using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// One residual block with room for its values.
struct EvaluatedBlock {
  const ResidualBlock* block;
  int term;
  double cost = 0;  // 1/2 rho(|r|^2)
  Eigen::VectorXd residuals;
  std::vector<Jacobian> jacobians;  // By node of the block.
};

/// The problem as blocks over twists.
class BlockProblem {
 public:
  BlockProblem(const SurfaceProblem& problem, const DeformationGraph& graph)
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

  /// Evaluates all blocks; false if a value is not finite.
  bool Evaluate(const std::vector<double>& twists, bool with_jacobians) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks_.size(), 64),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end();
                             ++i) {
                          EvaluateBlock(twists, with_jacobians, &blocks_[i]);
                        }
                      });
    return std::isfinite(Cost());
  }

  double Cost() const {
    double sum = 0;
    for (const EvaluatedBlock& block : blocks_) sum += block.cost;
    return sum;
  }

  std::vector<double> TermCosts() const {
    std::vector<double> costs(terms_.size(), 0.0);
    for (const EvaluatedBlock& block : blocks_) costs[block.term] += block.cost;
    return costs;
  }

  /// Matrix with a block wherever two nodes share a residual block.
  SymmetricBlockMatrix MakeMatrix() const {
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

  /// Sums J^T J and the gradient J^T r of all blocks.
  void Assemble(SymmetricBlockMatrix* matrix,
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

  const std::vector<TermBlocks>& terms() const { return terms_; }
  int residual_count() const { return residual_count_; }

 private:
  static void EvaluateBlock(const std::vector<double>& twists,
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

  static void Accumulate(const EvaluatedBlock& block,
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

  std::vector<TermBlocks> terms_;
  int nodes_;
  int residual_count_ = 0;
  std::vector<EvaluatedBlock> blocks_;
};

/// Adds diag(J^T J) / radius, Ceres' Levenberg-Marquardt damping.
void Damp(double radius, SymmetricBlockMatrix* matrix) {
  for (int i = 0; i < matrix->size(); ++i) {
    Block6& block = matrix->Diagonal(i);
    for (int d = 0; d < 6; ++d) {
      block(d, d) +=
          std::clamp(block(d, d), kMinDiagonal, kMaxDiagonal) / radius;
    }
  }
}

double MaxNorm(const std::vector<Vector6>& values) {
  double norm = 0;
  for (const Vector6& v : values)
    norm = std::max(norm, v.cwiseAbs().maxCoeff());
  return norm;
}

double Norm(const std::vector<Vector6>& values) {
  double sum = 0;
  for (const Vector6& v : values) sum += v.squaredNorm();
  return std::sqrt(sum);
}

/// One attempt of a step: solves (J^T J + D / radius) x = -J^T r.
CgResult SolveStep(SymmetricBlockMatrix matrix,
                   const std::vector<Vector6>& gradient, double radius,
                   const SolverOptions& options, std::vector<Vector6>* step) {
  Damp(radius, &matrix);
  std::vector<Vector6> right = gradient;
  for (Vector6& v : right) v = -v;
  return SolveByPcg(matrix, right, options.eta,
                    options.max_linear_solver_iterations, step);
}

std::vector<double> Moved(const std::vector<double>& twists,
                          const std::vector<Vector6>& step) {
  std::vector<double> moved = twists;
  for (std::size_t i = 0; i < step.size(); ++i) {
    for (int d = 0; d < 6; ++d) moved[kTwistSize * i + d] += step[i][d];
  }
  return moved;
}

/// Iteration 0, the start, as Ceres reports it.
SolverIteration Start(const SolverReport& report, double gradient_max_norm,
                      double radius) {
  SolverIteration start;
  start.cost = report.initial_cost;
  start.gradient_max_norm = gradient_max_norm;
  start.trust_region_radius = radius;
  start.seconds = report.jacobian_seconds;
  return start;
}

void AddTerms(const std::vector<TermBlocks>& terms,
              const std::vector<double>& initial,
              const std::vector<double>& final_costs, SolverReport* report) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    report->terms.push_back(terms[i].cost);
    report->terms.back().initial = initial[i];
    report->terms.back().final = final_costs[i];
  }
}

}  // namespace

SolverReport MinimizeWithGaussNewton(const SurfaceProblem& input,
                                     const SolverOptions& options,
                                     DeformationGraph* graph) {
  const Stopwatch total;
  SolverReport report;
  BlockProblem problem(input, *graph);
  std::vector<double> twists(kTwistSize * graph->size(), 0.0);
  Stopwatch watch;
  report.usable = problem.Evaluate(twists, /*with_jacobians=*/true);
  report.jacobian_seconds += watch.Restart();
  report.parameters = kTwistSize * graph->size();
  report.residuals = problem.residual_count();
  report.initial_cost = report.final_cost = problem.Cost();
  report.termination = report.usable ? "NO_CONVERGENCE" : "FAILURE";
  report.message = report.usable ? "Maximum number of iterations reached."
                                 : "The initial cost is not finite.";
  const std::vector<double> initial = problem.TermCosts();
  std::vector<double> final_costs = initial;
  SymmetricBlockMatrix matrix = problem.MakeMatrix();
  std::vector<Vector6> gradient, step;
  double radius = options.initial_radius;
  bool linearized = false;
  if (report.usable) {
    problem.Assemble(&matrix, &gradient);
    linearized = true;
    report.iterations.push_back(Start(report, MaxNorm(gradient), radius));
  }
  for (int i = 1; report.usable && i <= options.max_iterations; ++i) {
    const Stopwatch iteration_watch;
    SolverIteration iteration;
    iteration.iteration = i;
    watch.Restart();
    if (!linearized) {
      problem.Evaluate(twists, /*with_jacobians=*/true);
      report.jacobian_seconds += watch.Restart();
      problem.Assemble(&matrix, &gradient);
      linearized = true;
    }
    iteration.gradient_max_norm = MaxNorm(gradient);
    const CgResult cg = SolveStep(matrix, gradient, radius, options, &step);
    report.linear_solver_seconds += watch.Restart();
    iteration.linear_solver_iterations = cg.iterations;
    iteration.step_norm = Norm(step);
    const std::vector<double> moved = Moved(twists, step);
    const bool finite = problem.Evaluate(moved, /*with_jacobians=*/false);
    const double cost = problem.Cost();
    iteration.accepted = finite && cost <= report.final_cost;
    iteration.cost_change = finite ? report.final_cost - cost : 0;
    if (iteration.accepted) {
      twists = moved;
      report.final_cost = cost;
      final_costs = problem.TermCosts();
      radius *= 3;
      linearized = false;
    } else {
      radius /= 4;
    }
    iteration.cost = report.final_cost;
    iteration.trust_region_radius = radius;
    iteration.seconds = iteration_watch.Seconds();
    report.iterations.push_back(iteration);
    if (iteration.accepted &&
        (iteration.cost_change <=
             options.function_tolerance * report.final_cost ||
         iteration.gradient_max_norm <= options.gradient_tolerance ||
         iteration.step_norm <= options.parameter_tolerance)) {
      report.termination = "CONVERGENCE";
      report.message = "Cost, gradient or step below its tolerance.";
      break;
    }
  }
  AddTerms(problem.terms(), initial, final_costs, &report);
  if (report.usable) ComposeTwists(twists, graph);
  report.total_seconds = total.Seconds();
  return report;
}

}  // namespace splitfusion
