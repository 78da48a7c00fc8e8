#ifndef SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_
#define SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_

#include <string>
#include <vector>

namespace splitfusion {

/// Cost of one energy term: weight * (1/N) * sum of rho(|r|^2 / s^2).
struct TermCost {
  /// Registered name of the term.
  std::string term;
  int residual_vectors = 0;  ///< N of the normalisation.
  /// Before the minimisation.
  double initial = 0;
  /// After it.
  double final = 0;
};

/// What became of an unknown of a term's own.
struct UnknownEstimate {
  std::string term;    ///< Registered name of the term.
  std::string name;    ///< Of the unknown, see Unknown.
  std::string unit;    ///< Of the values.
  double initial = 0;  ///< Value before the minimisation.
  double final = 0;    ///< Value after it.
};

/// One iteration of the minimiser, as Ceres' IterationSummary has it.
struct SolverIteration {
  /// 0 is the start.
  int iteration = 0;
  /// Whether the step was taken.
  bool accepted = true;
  /// Cost after the iteration.
  double cost = 0;
  /// Decrease of the cost by the step.
  double cost_change = 0;
  /// Largest entry of the gradient after the iteration; NaN where it was not
  /// evaluated: by gn_* after the last step.
  double gradient_max_norm = 0;
  /// Length of the step (radians, metres; of the terms' own unknowns in units
  /// of their scales).
  double step_norm = 0;
  /// Radius that the damping stands for.
  double trust_region_radius = 0;
  /// Conjugate gradient iterations; 1 for a factorisation.
  int linear_solver_iterations = 0;
  /// |b - A x| / |b| of the step's linear system; Ceres does not tell (0).
  double linear_residual = 0;
  /// Wall-clock time.
  double seconds = 0;
};

/// Account of one minimisation.
struct SolverReport {
  bool usable = false;      ///< The graph holds the solution.
  std::string termination;  ///< "CONVERGENCE", "NO_CONVERGENCE", "FAILURE".
  /// The solver's words on why it ended.
  std::string message;
  /// Energy before.
  double initial_cost = 0;
  /// Energy after.
  double final_cost = 0;
  /// Number of unknowns.
  int parameters = 0;
  /// Number of scalar residuals.
  int residuals = 0;
  /// Time in residuals with Jacobians.
  double jacobian_seconds = 0;
  /// Time in the linear solver.
  double linear_solver_seconds = 0;
  /// Wall-clock time of the whole call.
  double total_seconds = 0;
  /// Costs by term, in order of the energy.
  std::vector<TermCost> terms;
  /// Of the terms' own unknowns, in order of the energy.
  std::vector<UnknownEstimate> unknowns;
  /// All iterations, the start first.
  std::vector<SolverIteration> iterations;
  std::string full_report;  ///< Ceres' FullReport(), on request.
};

/// What the terms' own unknowns were found to be, as SurfaceProblem::unknowns.
inline std::vector<double> FinalUnknowns(const SolverReport& report) {
  std::vector<double> values;
  for (const UnknownEstimate& unknown : report.unknowns) {
    values.push_back(unknown.final);
  }
  return values;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_
