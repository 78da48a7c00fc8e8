#include "splitfusion/lib/energy/linear_solver.h"

#include "splitfusion/lib/energy/pcg.h"

namespace splitfusion {
namespace {

/// Preconditioned conjugate gradients.
class PcgSolver : public LinearSolver {
 public:
  explicit PcgSolver(const SolverOptions& options) : options_(options) {}

  LinearSolution Solve(const SymmetricBlockMatrix& a,
                       const std::vector<Vector6>& b,
                       std::vector<Vector6>* x) override {
    const auto preconditioner = MakePreconditioner(options_.preconditioner, a);
    const CgResult result =
        SolveByPcg(a, *preconditioner, b, options_.eta,
                   options_.max_linear_solver_iterations, x);
    return {true, result.iterations, result.relative_residual};
  }

 private:
  const SolverOptions& options_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakeLinearSolver(const SolverOptions& options) {
  if (options.solver == "gn_cholesky") return MakeCholeskySolver();
  return std::make_unique<PcgSolver>(options);
}

}  // namespace splitfusion
