#include "splitfusion/lib/base/number_text.h"
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
               "Of gn_pcg and cgnr; auto is jacobi.");
  list->Choice("trust_region", &trust_region,
               {"levenberg_marquardt", "dogleg", "subspace_dogleg"},
               "Of ceres: how a step is kept short.");
  list->Choice("minimizer", &minimizer,
               {"trust_region", "lbfgs", "nonlinear_cg"},
               "Of ceres: steps of a linear solver in a trust region, or line "
               "searches without one.");
  list->Choice("sparse_library", &sparse_library,
               {"suite_sparse", "eigen_sparse"}, "Of sparse_normal_cholesky.");
  list->Choice("ordering", &ordering, {"amd", "nesdis", "natural"},
               "Order of elimination, of gn_cholesky and "
               "sparse_normal_cholesky: minimum degree, nested dissection, or "
               "as nodes were born.");
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
               "Write all there is to say of every solve; of ceres its "
               "FullReport().");
  DemandEffect(list);
}

void SolverOptions::DemandEffect(OptionList* list) const {
  const SolverOptions unset;
  const bool ceres = solver == "ceres";
  const bool gauss_newton = solver == "gn_pcg" || solver == "gn_cholesky";
  const bool line_search = minimizer != unset.minimizer;
  const bool conjugate_gradients =
      solver == "gn_pcg" || (ceres && linear_solver == "cgnr");
  const auto demand = [&](bool holds, const std::string& name,
                          const std::string& by_default,
                          const std::string& where) {
    list->Demand(holds, name,
                 by_default + ", as it has no effect but with " + where);
  };
  demand(!gauss_newton || linear_solver == unset.linear_solver, "linear_solver",
         unset.linear_solver, "solver ceres");
  demand(!gauss_newton || trust_region == unset.trust_region, "trust_region",
         unset.trust_region, "solver ceres");
  demand(!gauss_newton || !line_search, "minimizer", unset.minimizer,
         "solver ceres");
  demand(!line_search || (linear_solver == unset.linear_solver &&
                          trust_region == unset.trust_region),
         "minimizer", unset.minimizer,
         "linear_solver and trust_region left alone");
  demand(!(ceres || gauss_newton) || conjugate_gradients ||
             preconditioner == unset.preconditioner,
         "preconditioner", unset.preconditioner,
         "solver gn_pcg or linear_solver cgnr");
  const auto of_steps = [&](auto value, auto by_default,
                            const std::string& name) {
    demand(
        !(ceres || gauss_newton) || conjugate_gradients || value == by_default,
        name, NumberText(by_default), "solver gn_pcg or linear_solver cgnr");
  };
  of_steps(max_linear_solver_iterations, unset.max_linear_solver_iterations,
           "linear_iterations");
  of_steps(eta, unset.eta, "eta");
  const bool sparse = ceres && !line_search &&
                      (linear_solver == "sparse_normal_cholesky" ||
                       linear_solver == unset.linear_solver);
  demand(sparse_library == unset.sparse_library || sparse, "sparse_library",
         unset.sparse_library, "linear_solver sparse_normal_cholesky or auto");
  demand(!(ceres || gauss_newton) || ordering == unset.ordering ||
             solver == "gn_cholesky" ||
             (sparse && sparse_library == unset.sparse_library),
         "ordering", unset.ordering,
         "solver gn_cholesky, or sparse_normal_cholesky by suite_sparse");
  demand(!line_search || initial_radius == unset.initial_radius,
         "initial_radius", NumberText(unset.initial_radius),
         "minimizer trust_region");
  demand(!gauss_newton || threads == unset.threads, "solver_threads",
         std::to_string(unset.threads), "solver ceres");
  list->Demand(trust_region == unset.trust_region || linear_solver != "cgnr",
               "trust_region",
               "levenberg_marquardt with linear_solver cgnr (dogleg needs a "
               "factorisation)");
}

void SolverOptions::Check() const { CheckOptions(*this); }

}  // namespace splitfusion
