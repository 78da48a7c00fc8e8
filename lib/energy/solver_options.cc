#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

void SolverOptions::List(OptionList* list) {
  list->Text("solver", &solver,
             "Block Gauss-Newton with conjugate gradients (gn_pcg) or a "
             "factorisation (gn_cholesky), or ceres.")
      .common = true;
  list->Choice("linear_solver", &linear_solver,
               {"auto", "dense_qr", "dense_normal_cholesky",
                "sparse_normal_cholesky", "cgnr"},
               "Of ceres.")
      .common = true;
  list->Choice("preconditioner", &preconditioner,
               {"auto", "jacobi", "identity"},
               "Of gn_pcg and cgnr; auto is jacobi.")
      .common = true;
  list->Choice("trust_region", &trust_region, {"levenberg_marquardt", "dogleg"},
               "Of ceres: how a step is kept short.")
      .common = true;
  list->Demand(trust_region != "dogleg" || linear_solver != "cgnr",
               "trust_region",
               "levenberg_marquardt with linear_solver cgnr (dogleg needs a "
               "factorisation)");
  list->Number("solver_threads", &threads, {1, 1024}, "threads",
               "Of ceres; with more the last digits change from run to run.");
  list->Number("solver_iterations", &max_iterations, Range::AtLeast(1), "",
               "Iterations of the solver for each association.")
      .common = true;
  list->Number("linear_iterations", &max_linear_solver_iterations,
               Range::AtLeast(1), "",
               "Conjugate gradient iterations of a step at most (gn_pcg, "
               "cgnr).");
  list->Number("eta", &eta, {0, 1, true, true}, "",
               "Relative accuracy of a step's linear solve (gn_pcg, cgnr).");
  list->Number("function_tolerance", &function_tolerance, Range::AtLeast(0), "",
               "Converged when the cost changes by less, relative.");
  list->Number("gradient_tolerance", &gradient_tolerance, Range::AtLeast(0), "",
               "Converged when the gradient's largest entry is below.");
  list->Number("parameter_tolerance", &parameter_tolerance, Range::AtLeast(0),
               "", "Converged when the step is below (radians, metres).");
  list->Number("initial_radius", &initial_radius, Range::Above(0), "",
               "First radius of the trust region; 1 / damping.");
  list->Switch("full_report", &full_report,
               "Of ceres: write FullReport() of every solve.");
}

void SolverOptions::Check() const { CheckOptions(*this); }

}  // namespace splitfusion
