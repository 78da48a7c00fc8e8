#ifndef SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_
#define SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_

#include <string>
#include <vector>

namespace splitfusion {

/// Cost of one energy term: weight * (1/N) * sum of rho(|r|^2 / s^2).
struct TermCost {
  std::string term;
  int residual_vectors = 0;  ///< N of the normalisation.
  double initial = 0;
  double final = 0;
};

/// One iteration of the minimiser, as Ceres' IterationSummary has it.
struct SolverIteration {
  int iteration = 0;
  bool accepted = true;
  double cost = 0;
  double cost_change = 0;
  double gradient_max_norm = 0;
  double step_norm = 0;
  double trust_region_radius = 0;
  int linear_solver_iterations = 0;
  double seconds = 0;
};

/// Account of one minimisation.
struct SolverReport {
  bool usable = false;      ///< The graph holds the solution.
  std::string termination;  ///< "CONVERGENCE", "NO_CONVERGENCE", "FAILURE".
  std::string message;
  double initial_cost = 0;
  double final_cost = 0;
  int parameters = 0;
  int residuals = 0;
  double jacobian_seconds = 0;
  double linear_solver_seconds = 0;
  double total_seconds = 0;
  std::vector<TermCost> terms;
  std::vector<SolverIteration> iterations;
  std::string full_report;  ///< Ceres' FullReport(), on request.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SOLVER_REPORT_H_
