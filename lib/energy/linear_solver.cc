#include "splitfusion/lib/energy/linear_solver.h"

#include "splitfusion/lib/energy/pcg.h"

namespace splitfusion {
namespace {

/// g_i + t_i of all nodes, metres.
std::vector<Eigen::Vector3d> NodeCenters(const DeformationGraph& graph) {
  std::vector<Eigen::Vector3d> centers = graph.positions;
  for (int i = 0; i < graph.size(); ++i) {
    centers[i] += graph.motions[i].translation;
  }
  return centers;
}

/// Preconditioned conjugate gradients.
class PcgSolver : public LinearSolver {
 public:
  PcgSolver(const SolverOptions& options, const DeformationGraph& graph)
      : options_(options), centers_(NodeCenters(graph)) {}

  LinearSolution Solve(const SymmetricBlockMatrix& a,
                       const std::vector<Vector6>& b,
                       std::vector<Vector6>* x) override {
    const auto preconditioner =
        MakePreconditioner(options_.preconditioner, a, centers_);
    const CgResult result =
        SolveByPcg(a, *preconditioner, b, options_.eta,
                   options_.max_linear_solver_iterations, x);
    return {true, result.iterations, result.relative_residual};
  }

 private:
  const SolverOptions& options_;
  const std::vector<Eigen::Vector3d> centers_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakePcgSolver(const SolverOptions& options,
                                            const DeformationGraph& graph) {
  return std::make_unique<PcgSolver>(options, graph);
}

}  // namespace splitfusion
