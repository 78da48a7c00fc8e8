#include "splitfusion/lib/energy/block_ic0.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

/// The first raise of the diagonal.
constexpr double kFirstShift = 1e-3;  // Speed.

}  // namespace

BlockIc0::BlockIc0(const SymmetricBlockMatrix& matrix) : matrix_(matrix) {
  do {
    factor_ = matrix.blocks();
    for (const int diagonal : matrix.row_begin()) {
      if (diagonal == static_cast<int>(factor_.size())) break;
      factor_[diagonal].diagonal() *= 1 + shift_;
    }
    if (Factorize()) return;
    shift_ = std::max(kFirstShift, 2 * shift_);
  } while (std::isfinite(shift_));
}

bool BlockIc0::Factorize() {
  for (int row = 0; row < matrix_.size(); ++row) {
    Block6& diagonal = factor_[matrix_.row_begin()[row]];
    const Eigen::LLT<Eigen::Matrix<double, 6, 6>> cholesky(diagonal);
    if (cholesky.info() != Eigen::Success) return false;
    const Block6 inverse =
        cholesky.solve(Eigen::Matrix<double, 6, 6>::Identity());
    diagonal = 0.5 * (inverse + inverse.transpose());
    Eliminate(row, diagonal);
  }
  return true;
}

void BlockIc0::Eliminate(int row, const Block6& inverse) {
  const Block6 minus_inverse = -inverse;
  const std::vector<int>& begin = matrix_.row_begin();
  const std::vector<int>& columns = matrix_.columns();
  for (int a = begin[row] + 1; a < begin[row + 1]; ++a) {
    const Block6 own = factor_[a];
    factor_[a].setZero();
    AddTransposedProduct(minus_inverse.data(), own.data(), factor_[a].data());
    // W_jl -= W_ij^T D_i^-1 W_il for the columns l <= j that row l has, too.
    for (int b = begin[row] + 1; b <= a; ++b) {
      const int target = columns[b];
      const auto end = columns.begin() + begin[target + 1];
      const auto found =
          std::lower_bound(columns.begin() + begin[target], end, columns[a]);
      if (found == end || *found != columns[a]) continue;
      AddTransposedProduct(factor_[b].data(), own.data(),
                           factor_[found - columns.begin()].data());
    }
  }
}

double BlockIc0::Apply(const std::vector<Vector6>& in,
                       std::vector<Vector6>* out) const {
  return SolveFactorized(matrix_.size(), matrix_.row_begin().data(),
                         matrix_.columns().data(), factor_.data()->data(),
                         in.data()->data(), out->data()->data());
}

}  // namespace splitfusion
