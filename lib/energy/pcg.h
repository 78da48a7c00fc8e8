#ifndef SPLITFUSION_LIB_ENERGY_PCG_H_
#define SPLITFUSION_LIB_ENERGY_PCG_H_

#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/preconditioner.h"

namespace splitfusion {

/// Outcome of a conjugate gradient solution.
struct CgResult {
  /// Products with A.
  int iterations = 0;
  double relative_residual = 0;  ///< |b - A x| / |b|
};

/// Solves A x = b by preconditioned conjugate gradients from x = 0 until the
/// relative residual is below `tolerance` or `max_iterations` are done.
CgResult SolveByPcg(const SymmetricBlockMatrix& a,
                    const Preconditioner& preconditioner,
                    const std::vector<Vector6>& b, double tolerance,
                    int max_iterations, std::vector<Vector6>* x);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_PCG_H_
