#include "splitfusion/lib/energy/linear_solver.h"

#include "splitfusion/lib/energy/pcg.h"

namespace splitfusion {
namespace {

/// Preconditioned conjugate gradients.
class PcgSolver : public LinearSolver {
 public:
  explicit PcgSolver(const SolverOptions& options) : options_(options) {}

  LinearSolution Solve(const BorderedMatrix& m, const BorderedVector& b,
                       BorderedVector* x) override {
    const ReducedMatrix reduced(m);
    const CgResult result = SolveByPcg(
        reduced, MakePreconditioner(options_.preconditioner, reduced),
        reduced.RightSide(b), options_.eta,
        options_.max_linear_solver_iterations, &x->nodes);
    x->own = reduced.Own(b.own, x->nodes);
    return {reduced.usable(), result.iterations, result.relative_residual};
  }

 private:
  const SolverOptions& options_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakePcgSolver(const SolverOptions& options) {
  return std::make_unique<PcgSolver>(options);
}

}  // namespace splitfusion
