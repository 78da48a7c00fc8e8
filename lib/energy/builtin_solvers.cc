#include "splitfusion/lib/energy/linear_solver.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

SolverRegistry BuiltinSolvers() {
  SolverRegistry registry("solver");
  registry.Register("gn_pcg", [](const SolverOptions& options) {
    return MakeGaussNewton(options, MakePcgSolver);
  });
  registry.Register("gn_cholesky", [](const SolverOptions& options) {
    return MakeGaussNewton(options, MakeCholeskySolver);
  });
  registry.Register("ceres", MakeCeresSolver);
  return registry;
}

SolverReport Minimize(const SurfaceProblem& problem,
                      const SolverOptions& options, DeformationGraph* graph,
                      const SolverRegistry& solvers) {
  return solvers.Make(options.solver, options)->Minimize(problem, graph);
}

}  // namespace splitfusion
