#include <ceres/ceres.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/process_memory.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/ceres_blocks.h"
#include "splitfusion/lib/energy/ceres_watch.h"
#include "splitfusion/lib/energy/node_order.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_residuals.h"
#include "splitfusion/lib/energy/term_unknowns.h"

namespace splitfusion {
namespace {

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  return text;
}

/// The Ceres problem of one minimisation; it owns what is sought.
class CeresProblem {
 public:
  CeresProblem(const SurfaceProblem& input, const DeformationGraph& graph)
      : twists_(kTwistSize * graph.size(), 0.0),
        unknowns_(input),
        own_(unknowns_.Start()),
        problem_(ProblemOptions()) {
    for (int i = 0; i < graph.size(); ++i) {
      problem_.AddParameterBlock(&twists_[kTwistSize * i], kTwistSize);
    }
    terms_ = CollectResiduals(input, unknowns_, graph);
    ids_.resize(terms_.size());
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      double* own = own_.data() + unknowns_.first(t);
      if (unknowns_.count(t) > 0) {
        problem_.AddParameterBlock(own, unknowns_.count(t));
      }
      for (ResidualBlock& block : MakeCeresBlocks(graph, terms_[t].residuals)) {
        block.cost = watch_.Guard(terms_[t].cost.term, std::move(block.cost));
        ids_[t].push_back(Add(std::move(block), own));
      }
    }
  }

  /// What became of the terms' own unknowns.
  std::vector<UnknownEstimate> Unknowns() const {
    return unknowns_.Estimates(own_.data());
  }

  /// Cost of every term at the current twists.
  ///
  /// @throw What a term throws.
  std::vector<double> TermCosts() {
    std::vector<double> costs;
    for (const auto& ids : ids_) {
      double cost = 0;
      if (!ids.empty()) {
        ceres::Problem::EvaluateOptions options;
        options.residual_blocks = ids;
        if (!problem_.Evaluate(options, &cost, nullptr, nullptr, nullptr)) {
          cost = std::nan("");
        }
      }
      costs.push_back(cost);
    }
    watch_.Rethrow();
    return costs;
  }

  /// @throw What a term throws.
  ceres::Solver::Summary Solve(const ceres::Solver::Options& options) {
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    watch_.Rethrow();
    return summary;
  }

  /// A sentence on the first term whose derivatives were found not to be
  /// finite; empty: none.
  std::string NotFinite() const { return watch_.NotFinite(); }

  std::vector<TermCost> Terms(const std::vector<double>& initial,
                              const std::vector<double>& final_costs) const {
    std::vector<TermCost> costs;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      costs.push_back(terms_[i].cost);
      costs.back().initial = initial[i];
      costs.back().final = final_costs[i];
    }
    return costs;
  }

  /// The order of elimination, one block of unknowns after the other; those of
  /// the terms' own, which couple with all, last.
  std::shared_ptr<ceres::ParameterBlockOrdering> Order(
      const std::string& ordering) const {
    const int nodes = static_cast<int>(twists_.size()) / kTwistSize;
    const std::vector<int> places = OrderNodes(nodes, CoupledNodes(), ordering);
    auto order = std::make_shared<ceres::ParameterBlockOrdering>();
    std::vector<double*> blocks;
    problem_.GetParameterBlocks(&blocks);
    int last = nodes;
    for (double* block : blocks) {
      const int node = NodeOf(block);
      order->AddElementToGroup(block, node >= 0 ? places[node] : last++);
    }
    return order;
  }

  const ceres::Problem& problem() const { return problem_; }
  const std::vector<ProblemTerm>& terms() const { return terms_; }
  const std::vector<double>& twists() const { return twists_; }

 private:
  /// Of a block of twists; -1: of another block.
  int NodeOf(const double* block) const {
    const auto at = block - twists_.data();
    const bool is_twist = at >= 0 && at < static_cast<long>(twists_.size());
    return is_twist ? static_cast<int>(at) / kTwistSize : -1;
  }

  /// Pairs of nodes that a residual depends on.
  std::vector<std::pair<int, int>> CoupledNodes() const {
    std::vector<std::pair<int, int>> coupled;
    std::vector<ceres::ResidualBlockId> residuals;
    problem_.GetResidualBlocks(&residuals);
    std::vector<double*> blocks;
    for (const ceres::ResidualBlockId id : residuals) {
      problem_.GetParameterBlocksForResidualBlock(id, &blocks);
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const int a = NodeOf(blocks[j]), b = NodeOf(blocks[i]);
          if (a >= 0 && b >= 0) coupled.emplace_back(a, b);
        }
      }
    }
    return coupled;
  }

  static ceres::Problem::Options ProblemOptions() {
    ceres::Problem::Options options;
    options.disable_all_safety_checks = true;
    return options;
  }

  /// `own`: the unknowns of its term.
  ceres::ResidualBlockId Add(ResidualBlock block, double* own) {
    std::vector<double*> parameters;
    for (const int node : block.nodes) {
      parameters.push_back(&twists_[kTwistSize * node]);
    }
    if (block.has_unknowns) parameters.push_back(own);
    return problem_.AddResidualBlock(block.cost.release(), nullptr, parameters);
  }

  std::vector<double> twists_;
  TermUnknowns unknowns_;
  std::vector<double> own_;  // As sought.
  std::vector<ProblemTerm> terms_;
  std::vector<std::vector<ceres::ResidualBlockId>> ids_;  // By term.
  CeresWatch watch_;
  ceres::Problem problem_;
};

bool IsDense(ceres::LinearSolverType type) {
  return type == ceres::DENSE_QR || type == ceres::DENSE_NORMAL_CHOLESKY;
}

/// What a dense solver needs: the Jacobian, and the normal equations or another
/// copy of it.
double DenseBytes(const ceres::Problem& problem) {
  return 2.0 * sizeof(double) * problem.NumParameters() *
         std::max(problem.NumResiduals(), problem.NumParameters());
}

std::string Gigabytes(double bytes) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << bytes / 1e9 << " GB";
  return text.str();
}

ceres::Solver::Options CeresOptions(const SolverOptions& options,
                                    const DeformationGraph& graph) {
  ceres::Solver::Options ceres_options;
  std::string linear_solver = options.linear_solver;
  if (linear_solver == "auto") {
    linear_solver =
        graph.rigid() ? "dense_normal_cholesky" : "sparse_normal_cholesky";
  }
  ceres::StringToLinearSolverType(Upper(linear_solver),
                                  &ceres_options.linear_solver_type);
  const bool is_auto = options.preconditioner == "auto";
  ceres::StringToPreconditionerType(
      Upper(is_auto ? "jacobi" : options.preconditioner),
      &ceres_options.preconditioner_type);
  if (options.trust_region != "levenberg_marquardt") {
    ceres_options.trust_region_strategy_type = ceres::DOGLEG;
    ceres_options.dogleg_type = options.trust_region == "dogleg"
                                    ? ceres::TRADITIONAL_DOGLEG
                                    : ceres::SUBSPACE_DOGLEG;
  }
  if (options.minimizer != "trust_region") {
    ceres_options.minimizer_type = ceres::LINE_SEARCH;
    ceres_options.line_search_direction_type =
        options.minimizer == "lbfgs" ? ceres::LBFGS
                                     : ceres::NONLINEAR_CONJUGATE_GRADIENT;
  }
  ceres::StringToSparseLinearAlgebraLibraryType(
      Upper(options.sparse_library),
      &ceres_options.sparse_linear_algebra_library_type);
  ceres_options.num_threads = options.threads;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.max_linear_solver_iterations =
      options.max_linear_solver_iterations;
  ceres_options.eta = options.eta;
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.gradient_tolerance = options.gradient_tolerance;
  ceres_options.parameter_tolerance = options.parameter_tolerance;
  ceres_options.initial_trust_region_radius = options.initial_radius;
  ceres_options.max_solver_time_in_seconds = options.max_seconds;
  ceres_options.logging_type = ceres::SILENT;
  return ceres_options;
}

void FillReport(const ceres::Solver::Summary& summary, bool full_report,
                SolverReport* report) {
  report->usable =
      summary.IsSolutionUsable() && std::isfinite(summary.final_cost);
  report->termination =
      ceres::TerminationTypeToString(summary.termination_type);
  report->message = summary.message;
  report->initial_cost = summary.initial_cost;
  report->final_cost = summary.final_cost;
  report->parameters = summary.num_effective_parameters;
  report->jacobian_seconds = summary.jacobian_evaluation_time_in_seconds;
  report->linear_solver_seconds = summary.linear_solver_time_in_seconds;
  for (const ceres::IterationSummary& it : summary.iterations) {
    report->iterations.push_back(
        {it.iteration, it.step_is_successful, it.cost, it.cost_change,
         it.gradient_max_norm, it.step_norm, it.trust_region_radius,
         it.linear_solver_iterations, /*linear_residual=*/0,
         it.iteration_time_in_seconds});
  }
  if (full_report) report->full_report = summary.FullReport();
}

class CeresSolver : public Solver {
 public:
  explicit CeresSolver(const SolverOptions& options) : options_(options) {
    constexpr double kLeast = 1e-32, kLargest = 1e16;  // Format: of Ceres.
    CheckOption(
        options.initial_radius >= kLeast && options.initial_radius <= kLargest,
        "initial_radius", options.initial_radius,
        "1e-32..1e16 with solver ceres");
  }

  SolverReport Minimize(const SurfaceProblem& input,
                        DeformationGraph* graph) const override {
    const Stopwatch stopwatch;
    SolverReport report;
    CeresProblem problem(input, *graph);
    report.residuals = CountResiduals(problem.terms());
    const std::vector<double> initial = problem.TermCosts();
    const double initial_cost =
        std::accumulate(initial.begin(), initial.end(), 0.0);
    ceres::Solver::Options options = CeresOptions(options_, *graph);
    const double needed =
        IsDense(options.linear_solver_type) ? DenseBytes(problem.problem()) : 0;
    const auto free = static_cast<double>(AvailableMemoryBytes());
    if (needed > free) {
      report.termination = "FAILURE";
      report.initial_cost = initial_cost;
      report.message = options_.linear_solver + " needs " + Gigabytes(needed) +
                       " of memory: " + Gigabytes(free) + " are free";
      return report;
    }
    if (input.initial_radius > 0) {
      options.initial_trust_region_radius = input.initial_radius;
    }
    if (options_.ordering != SolverOptions().ordering) {
      options.linear_solver_ordering = problem.Order(options_.ordering);
    }
    if (std::isfinite(initial_cost)) {
      FillReport(problem.Solve(options), options_.full_report, &report);
      if (!report.usable && !problem.NotFinite().empty()) {
        report.message = problem.NotFinite();
      }
    } else {
      report.termination = "FAILURE";
      report.message = NotFiniteText(problem.terms(), initial);
      report.parameters = problem.problem().NumParameters();
    }
    // Ceres has -1 where it could not evaluate.
    if (!report.usable) report.initial_cost = initial_cost;
    report.terms = problem.Terms(initial, problem.TermCosts());
    report.unknowns = problem.Unknowns();
    if (report.usable) ComposeTwists(problem.twists(), graph);
    report.total_seconds = stopwatch.Seconds();
    return report;
  }

 private:
  SolverOptions options_;
};

}  // namespace

std::unique_ptr<Solver> MakeCeresSolver(const SolverOptions& options) {
  return std::make_unique<CeresSolver>(options);
}

}  // namespace splitfusion
