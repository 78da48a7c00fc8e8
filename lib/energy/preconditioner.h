#ifndef SPLITFUSION_LIB_ENERGY_PRECONDITIONER_H_
#define SPLITFUSION_LIB_ENERGY_PRECONDITIONER_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// An approximate inverse of a matrix: symmetric, positive definite.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// out = M^-1 in; returns in . out. `out` has the size of `in`.
  virtual double Apply(const std::vector<Vector6>& in,
                       std::vector<Vector6>* out) const = 0;
};

/// Inverses of the diagonal blocks of a positive definite matrix.
Blocks6 InverseDiagonal(const SymmetricBlockMatrix& matrix);

/// Preconditioner of a matrix: identity, jacobi (inverses of the diagonal
/// blocks), block_ic0 (incomplete Cholesky factor with the blocks of the
/// matrix itself) or two_level (see TwoLevel), which auto is, too.
/// `centers`: g_i + t_i of the nodes, metres; nothing else asks for them.
///
/// @throw InputError on an unknown name; lists the known ones.
std::unique_ptr<Preconditioner> MakePreconditioner(
    const std::string& name, const SymmetricBlockMatrix& matrix,
    const std::vector<Eigen::Vector3d>& centers);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_PRECONDITIONER_H_
