#ifndef SPLITFUSION_LIB_ENERGY_PCG_H_
#define SPLITFUSION_LIB_ENERGY_PCG_H_

#include <string>
#include <vector>

#include "splitfusion/lib/energy/bordered_matrix.h"

namespace splitfusion {

/// Outcome of a conjugate gradient solution.
struct CgResult {
  /// Products with A.
  int iterations = 0;
  double relative_residual = 0;  ///< |b - A x| / |b|
};

/// Preconditioner of a positive definite matrix by its name: the inverses of
/// its diagonal blocks (jacobi, auto), or the identity.
///
/// @throw InputError on an unknown name; lists the known ones.
Blocks6 MakePreconditioner(const std::string& name,
                           const ReducedMatrix& matrix);

/// Solves A x = b by conjugate gradients, preconditioned by diagonal blocks,
/// from x = 0 until the relative residual is below `tolerance` or
/// `max_iterations` are done.
CgResult SolveByPcg(const ReducedMatrix& a, const Blocks6& preconditioner,
                    const std::vector<Vector6>& b, double tolerance,
                    int max_iterations, std::vector<Vector6>* x);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_PCG_H_
