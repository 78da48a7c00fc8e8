#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/bordered_matrix.h"
#include "splitfusion/lib/energy/linear_solver.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_residuals.h"

namespace splitfusion {
namespace {

/// Bounds of the diagonal that damping is relative to, as in Ceres.
constexpr double kMinDiagonal = 1e-6;  // Maths.
constexpr double kMaxDiagonal = 1e32;

double MaxNorm(const BorderedVector& values) {
  double norm = 0;
  for (const Vector6& v : values.nodes)
    norm = std::max(norm, v.cwiseAbs().maxCoeff());
  for (const double v : values.own) norm = std::max(norm, std::abs(v));
  return norm;
}

double Norm(const BorderedVector& values) {
  double sum = 0;
  for (const Vector6& v : values.nodes) sum += v.squaredNorm();
  return std::sqrt(sum + values.own.squaredNorm());
}

BorderedVector Negative(BorderedVector values) {
  for (Vector6& v : values.nodes) v = -v;
  values.own = -values.own;
  return values;
}

std::vector<double> Moved(const std::vector<double>& sought,
                          const BorderedVector& step) {
  std::vector<double> moved = sought;
  std::size_t at = 0;
  for (const Vector6& v : step.nodes) {
    for (int d = 0; d < 6; ++d) moved[at++] += v[d];
  }
  for (const double v : step.own) moved[at++] += v;
  return moved;
}

/// What damping adds to these entries of a diagonal, as in Ceres.
template <typename Vector>
Vector Damping(const Vector& diagonal, double radius) {
  return diagonal.cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal) / radius;
}

/// All there is to say of a solve, as Ceres' FullReport().
std::string FullText(const SolverReport& report, const std::string& solver,
                     const SymmetricBlockMatrix& matrix) {
  std::ostringstream text;
  const double nodes = matrix.size();
  text << "Solver Summary (" << solver << ": Gauss-Newton on 6x6 blocks, "
       << "Levenberg-Marquardt damping)\n\n"
       << "Parameters          " << report.parameters << " (" << matrix.size()
       << " nodes)\nResiduals           " << report.residuals
       << "\nBlocks of J^T J      " << matrix.block_count()
       << " of the upper triangle ("
       << 200 * double(matrix.block_count()) / (nodes * (nodes + 1))
       << " %)\n\nCost                initial, final\n";
  for (const TermCost& term : report.terms) {
    text << "  " << std::left << std::setw(18) << term.term << term.initial
         << ", " << term.final << " (" << term.residual_vectors
         << " residual vectors)\n";
  }
  for (const UnknownEstimate& unknown : report.unknowns) {
    text << "  " << unknown.term << '.' << unknown.name << "  "
         << unknown.initial << ", " << unknown.final << ' ' << unknown.unit
         << '\n';
  }
  text << "  " << std::setw(18) << "sum" << report.initial_cost << ", "
       << report.final_cost
       << "\n\niteration  cost  change  |gradient|  |step|  radius  "
          "linear_iterations  seconds\n";
  for (const SolverIteration& it : report.iterations) {
    text << it.iteration << (it.accepted ? "  " : " (not taken)  ") << it.cost
         << "  " << it.cost_change << "  " << it.gradient_max_norm << "  "
         << it.step_norm << "  " << it.trust_region_radius << "  "
         << it.linear_solver_iterations << "  " << it.seconds << '\n';
  }
  text << "\nSeconds             Jacobians " << report.jacobian_seconds
       << ", assembly and linear solver " << report.linear_solver_seconds
       << ", total " << report.total_seconds
       << "\nTermination:        " << report.termination << " ("
       << report.message << ")\n";
  return text.str();
}

/// A minimisation under way, about what was reached so far.
class Minimization {
 public:
  /// Evaluates the start; Usable() says whether its cost is finite.
  Minimization(const SurfaceProblem& input, const SolverOptions& options,
               LinearSolverFactory linear, const DeformationGraph& graph)
      : options_(options),
        problem_(input, graph),
        matrix_(problem_.MakeMatrix()),
        linear_solver_(linear(options)),
        sought_(problem_.Start()),
        radius_(input.initial_radius > 0 ? input.initial_radius
                                         : options.initial_radius) {
    const bool finite = EvaluateJacobians();
    report_.usable = finite;
    report_.parameters = static_cast<int>(sought_.size());
    report_.residuals = CountResiduals(problem_.terms());
    report_.initial_cost = report_.final_cost = problem_.Cost();
    report_.termination = finite ? "NO_CONVERGENCE" : "FAILURE";
    initial_costs_ = final_costs_ = problem_.TermCosts();
    report_.message = finite ? "Maximum number of iterations reached."
                             : NotFiniteText(problem_.terms(), final_costs_);
  }

  /// Iterates until a tolerance or the number of iterations is reached.
  void Run() {
    if (!report_.usable) return;
    AddStart();
    const Stopwatch watch;
    for (int i = 1; i <= options_.max_iterations; ++i) {
      if (watch.Seconds() > options_.max_seconds) {
        report_.message = "Maximum time reached.";
        return;
      }
      if (!LinearizeHere()) return Fail(problem_.NotFiniteAt(sought_));
      if (report_.iterations.back().gradient_max_norm <=
          options_.gradient_tolerance) {
        return Converge("Gradient below its tolerance.");
      }
      report_.iterations.push_back(Iterate(i));
      if (HasSettled(report_.iterations.back())) {
        return Converge("Change of the cost or step below its tolerance.");
      }
    }
    if (!why_not_taken_.empty()) {
      report_.message += " The last step was not taken: " + why_not_taken_;
    }
  }

  /// The report without the total time; terms with their costs.
  SolverReport Report() const {
    SolverReport report = report_;
    for (std::size_t i = 0; i < problem_.terms().size(); ++i) {
      report.terms.push_back(problem_.terms()[i].cost);
      report.terms.back().initial = initial_costs_[i];
      report.terms.back().final = final_costs_[i];
    }
    report.unknowns = problem_.unknowns().Estimates(
        sought_.data() + kTwistSize * matrix_.nodes.size());
    return report;
  }

  bool Usable() const { return report_.usable; }
  const SymmetricBlockMatrix& matrix() const { return matrix_.nodes; }
  /// Twists, and what follows them.
  const std::vector<double>& sought() const { return sought_; }

 private:
  bool EvaluateJacobians() {
    const Stopwatch watch;
    const bool finite = problem_.Evaluate(sought_, /*with_jacobians=*/true);
    report_.jacobian_seconds += watch.Seconds();
    return finite;
  }

  void Converge(const std::string& message) {
    report_.termination = "CONVERGENCE";
    report_.message = message;
  }

  void Fail(const std::string& message) {
    report_.usable = false;
    report_.termination = "FAILURE";
    report_.message = message;
  }

  /// Normal equations at what was reached, and, in the iteration that reached
  /// it, the gradient there. False if they are not finite.
  bool LinearizeHere() {
    if (linearized_) return true;
    SolverIteration& reached = report_.iterations.back();
    const Stopwatch watch;
    if (reached.iteration > 0) EvaluateJacobians();
    const Stopwatch assembly;
    problem_.Assemble(&matrix_, &gradient_);
    diagonal_ = DiagonalOf(matrix_);
    linearized_ = true;
    report_.linear_solver_seconds += assembly.Seconds();
    reached.gradient_max_norm = MaxNorm(gradient_);
    reached.seconds += watch.Seconds();
    return IsFinite(gradient_) && IsFinite(diagonal_);
  }

  /// Adds diag(J^T J) / radius, Ceres' Levenberg-Marquardt damping.
  void Damp() {
    for (int i = 0; i < matrix_.nodes.size(); ++i) {
      matrix_.nodes.Diagonal(i).diagonal() =
          diagonal_.nodes[i] + Damping(diagonal_.nodes[i], radius_);
    }
    matrix_.corner.diagonal() = diagonal_.own + Damping(diagonal_.own, radius_);
  }

  /// Solves (J^T J + D / radius) x = -J^T r.
  LinearSolution SolveStep() {
    Damp();
    return linear_solver_->Solve(matrix_, Negative(gradient_), &step_);
  }

  /// Iteration 0, the start, as Ceres reports it.
  void AddStart() {
    SolverIteration start;
    start.cost = report_.initial_cost;
    start.trust_region_radius = radius_;
    start.seconds = report_.jacobian_seconds;
    report_.iterations.push_back(start);
  }

  SolverIteration Iterate(int number) {
    const Stopwatch iteration_watch;
    SolverIteration iteration;
    iteration.iteration = number;
    // Not known before it is needed: it takes the Jacobians.
    iteration.gradient_max_norm = std::nan("");
    const Stopwatch watch;
    const LinearSolution solution = SolveStep();
    solved_ = solution.usable;
    report_.linear_solver_seconds += watch.Seconds();
    iteration.linear_solver_iterations = solution.iterations;
    iteration.linear_residual = solution.relative_residual;
    iteration.step_norm = Norm(step_);
    TryStep(solution.usable, &iteration);
    iteration.cost = report_.final_cost;
    iteration.trust_region_radius = radius_;
    iteration.seconds = iteration_watch.Seconds();
    return iteration;
  }

  /// Takes the step if it does not raise the cost, and adapts the radius.
  void TryStep(bool usable, SolverIteration* iteration) {
    std::vector<double> moved = Moved(sought_, step_);
    const bool finite =
        usable && problem_.Evaluate(moved, /*with_jacobians=*/false);
    const double cost = problem_.Cost();
    why_not_taken_ =
        !usable  ? "its linear system could not be solved."
        : finite ? ""
                 : NotFiniteText(problem_.terms(), problem_.TermCosts());
    iteration->accepted = finite && cost <= report_.final_cost;
    iteration->cost_change = finite ? report_.final_cost - cost : 0;
    if (!iteration->accepted) {
      radius_ /= 4;
      // Where it still is.
      iteration->gradient_max_norm = MaxNorm(gradient_);
      return;
    }
    sought_ = std::move(moved);
    report_.final_cost = cost;
    final_costs_ = problem_.TermCosts();
    radius_ *= 3;
    linearized_ = false;
  }

  bool HasSettled(const SolverIteration& iteration) const {
    return (solved_ && iteration.step_norm <= options_.parameter_tolerance) ||
           (iteration.accepted &&
            iteration.cost_change <=
                options_.function_tolerance * report_.final_cost);
  }

  const SolverOptions& options_;
  BlockProblem problem_;
  BorderedMatrix matrix_;
  std::unique_ptr<LinearSolver> linear_solver_;
  BorderedVector diagonal_;     // Of J^T J, without damping.
  std::vector<double> sought_;  // As BlockProblem::Start().
  double radius_;
  std::string why_not_taken_;  // The last step; empty: its cost.
  bool solved_ = false;        // Whether the last step is that of its system.
  bool linearized_ = false;    // Whether matrix_ and gradient_ are at sought_.
  BorderedVector gradient_;
  BorderedVector step_;
  std::vector<double> initial_costs_;  // By term.
  std::vector<double> final_costs_;    // By term.
  SolverReport report_;
};

class GaussNewton : public Solver {
 public:
  GaussNewton(const SolverOptions& options, LinearSolverFactory linear)
      : options_(options), linear_(linear) {}

  SolverReport Minimize(const SurfaceProblem& problem,
                        DeformationGraph* graph) const override {
    const Stopwatch total;
    Minimization minimization(problem, options_, linear_, *graph);
    minimization.Run();
    SolverReport report = minimization.Report();
    if (minimization.Usable()) ComposeTwists(minimization.sought(), graph);
    report.total_seconds = total.Seconds();
    if (options_.full_report) {
      report.full_report =
          FullText(report, options_.solver, minimization.matrix());
    }
    return report;
  }

 private:
  SolverOptions options_;
  LinearSolverFactory linear_;
};

}  // namespace

std::unique_ptr<Solver> MakeGaussNewton(const SolverOptions& options,
                                        LinearSolverFactory linear) {
  return std::make_unique<GaussNewton>(options, linear);
}

}  // namespace splitfusion
