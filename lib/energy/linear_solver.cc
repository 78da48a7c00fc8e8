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
    const CgResult result =
        SolveByPcg(a, MakePreconditioner(options_.preconditioner, a), b,
                   options_.eta, options_.max_linear_solver_iterations, x);
    return {true, result.iterations, result.relative_residual};
  }

 private:
  const SolverOptions& options_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakePcgSolver(const SolverOptions& options) {
  return std::make_unique<PcgSolver>(options);
}

}  // namespace splitfusion
