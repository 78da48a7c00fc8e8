#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_IC0_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_IC0_H_

#include <vector>

#include "splitfusion/lib/energy/preconditioner.h"

namespace splitfusion {

/// Block incomplete Cholesky factorisation without fill:
///
///   A ~ M = U^T D U,  U unit upper triangular with the blocks of A's pattern
///
/// M equals A at every block of the pattern. If a diagonal block of D is not
/// positive definite, the diagonal of A is raised (1e-3, then twice as much,
/// ... of itself) and it begins anew.
class BlockIc0 : public Preconditioner {
 public:
  /// Factorises; `matrix` must outlive this, only its pattern is used later.
  explicit BlockIc0(const SymmetricBlockMatrix& matrix);

  double Apply(const std::vector<Vector6>& in,
               std::vector<Vector6>* out) const override;

  /// What the diagonal of A was raised by, relative.
  double shift() const { return shift_; }

 private:
  bool Factorize();
  void Eliminate(int row, const Block6& inverse);

  const SymmetricBlockMatrix& matrix_;
  double shift_ = 0;
  Blocks6 factor_;  // D^-1 and -U, at their places in the matrix.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_IC0_H_
