#ifndef SPLITFUSION_LIB_ENERGY_SELECTED_INVERSE_H_
#define SPLITFUSION_LIB_ENERGY_SELECTED_INVERSE_H_

#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// The blocks of the inverse Z of a sparse symmetric positive semi-definite
/// matrix A that lie where A has blocks, without the dense rest.
///
/// A = L D L^T with unit lower triangular L and 6x6 blocks D; from Z L =
/// L^-T D^-1, whose lower triangle is D^-1 (Takahashi et al. 1973),
///
///   Z_ij = -sum_k Z_ik L_kj  (i > j),   Z_jj = D_j^-1 - sum_k Z_kj^T L_kj,
///
/// k over the blocks of column j of L. That needs Z where L has blocks alone,
/// and costs as much as the factorisation. The order of all sums is fixed.
class SelectedInverse {
 public:
  /// @param matrix A; its blocks may be zero where those of Z are wanted.
  /// @param least > 0. What A says of a node's directions, given the nodes that
  ///     are eliminated later (the eigenvalues of D), counts as no less than
  ///     this: a singular matrix has an inverse, in which what nothing holds
  ///     has about the variance 1 / least.
  SelectedInverse(const SymmetricBlockMatrix& matrix, double least);

  /// Block (i, j) of the inverse; A must have a block there or at (j, i).
  Block6 Block(int i, int j) const { return At(places_[i], places_[j]); }

 private:
  /// What a column has below the diagonal, by reordered nodes.
  struct Column {
    std::vector<int> rows;  // Ascending.
    Blocks6 blocks;         // Of A, then of L, then of Z.
    Block6 diagonal;        // Of A, then D^-1, then of Z.
  };

  void CollectColumns(const SymmetricBlockMatrix& matrix);
  void FillIn();
  void CopyBlocks(const SymmetricBlockMatrix& matrix);
  void Eliminate(int j, double least);
  void Invert(int j);

  /// Block below the diagonal, which is there.
  Block6& Below(int row, int column);
  /// Block (row, column) of Z, once both columns are inverted.
  Block6 At(int row, int column) const;

  std::vector<int> places_;  // Of the nodes.
  std::vector<Column> columns_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SELECTED_INVERSE_H_
