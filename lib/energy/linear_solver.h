#ifndef SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_
#define SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/energy/bordered_matrix.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// Outcome of one linear system.
struct LinearSolution {
  bool usable = true;  ///< False if the matrix could not be factorised.
  /// Of conjugate gradients; 1 for a factorisation.
  int iterations = 0;
  /// |b - M x| / |b|; of conjugate gradients that of the system that is left
  /// for the twists, see ReducedMatrix.
  double relative_residual = 0;
};

/// Solves the linear systems of one minimisation, all of one pattern.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Solves M x = b.
  virtual LinearSolution Solve(const BorderedMatrix& m, const BorderedVector& b,
                               BorderedVector* x) = 0;
};

/// Makes the linear solver of one minimisation; the options must outlive it.
using LinearSolverFactory =
    std::unique_ptr<LinearSolver> (*)(const SolverOptions& options);

/// Conjugate gradients on what is left for the twists, preconditioned as the
/// options say.
std::unique_ptr<LinearSolver> MakePcgSolver(const SolverOptions& options);

/// Supernodal Cholesky factorisation by CHOLMOD: of the nodes' part, once, and
/// of the Schur complement of the terms' own unknowns. Nodes are ordered once,
/// for the pattern of the first matrix; later ones must have the same.
std::unique_ptr<LinearSolver> MakeCholeskySolver(const SolverOptions& options);

/// Levenberg-Marquardt on assembled 6x6 blocks of J^T J, whose systems `linear`
/// solves: by preconditioned conjugate gradients gn_pcg (Eq. 7 as the paper
/// solves it), by a factorisation gn_cholesky. Residuals, losses and damping
/// are those of Ceres. Results do not depend on the number of threads.
std::unique_ptr<Solver> MakeGaussNewton(const SolverOptions& options,
                                        LinearSolverFactory linear);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_LINEAR_SOLVER_H_
