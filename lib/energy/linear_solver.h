#ifndef SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_
#define SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// Outcome of one linear system.
struct LinearSolution {
  bool usable = true;  ///< False if the matrix could not be factorised.
  /// Of conjugate gradients; 1 for a factorisation.
  int iterations = 0;
  double relative_residual = 0;  ///< |b - A x| / |b|
};

/// Solves the linear systems of one minimisation, all of one pattern.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Solves A x = b.
  virtual LinearSolution Solve(const SymmetricBlockMatrix& a,
                               const std::vector<Vector6>& b,
                               std::vector<Vector6>* x) = 0;
};

/// The linear solver of gn_pcg or gn_cholesky for the twists of the graph's
/// nodes, as they are now; `options` must outlive it.
std::unique_ptr<LinearSolver> MakeLinearSolver(const SolverOptions& options,
                                               const DeformationGraph& graph);

/// Supernodal Cholesky factorisation by CHOLMOD. Nodes are ordered once, for
/// the pattern of the first matrix; later ones must have the same.
std::unique_ptr<LinearSolver> MakeCholeskySolver();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_
