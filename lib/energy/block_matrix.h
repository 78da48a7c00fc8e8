#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_MATRIX_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_MATRIX_H_

#include <tbb/cache_aligned_allocator.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace splitfusion {

/// A 6x6 block, one node pair's share of the normal equations.
using Block6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
/// A node's share of a vector over all twists.
using Vector6 = Eigen::Matrix<double, 6, 1>;
/// Many blocks, aligned for wide vectors.
using Blocks6 = std::vector<Block6, tbb::cache_aligned_allocator<Block6>>;

/// Symmetric positive semi-definite matrix of 6x6 blocks; the upper triangle is
/// stored by rows, each beginning with the diagonal.
class SymmetricBlockMatrix {
 public:
  /// `pairs`: block positions (row, column), row <= column, any order,
  /// repetitions allowed; the diagonal is always there.
  SymmetricBlockMatrix(int nodes, std::vector<std::pair<int, int>> pairs);

  /// Row i holds the columns row_begin[i] .. row_begin[i + 1] of `columns`,
  /// ascending from i itself.
  SymmetricBlockMatrix(std::vector<int> row_begin, std::vector<int> columns);

  /// Number of block rows.
  int size() const { return static_cast<int>(row_begin_.size()) - 1; }
  /// Number of stored blocks.
  std::size_t block_count() const { return columns_.size(); }
  /// Where the rows begin among the blocks, and where the last one ends.
  const std::vector<int>& row_begin() const { return row_begin_; }
  /// Block columns of all blocks.
  const std::vector<int>& columns() const { return columns_; }

  /// Where block (row, column) is stored; row <= column and it is in `pairs`.
  int Index(int row, int column) const;

  /// Blocks by their index; zero at first.
  Blocks6& blocks() { return blocks_; }
  /// Blocks by their index.
  const Blocks6& blocks() const { return blocks_; }

  /// Diagonal block of a row.
  const Block6& Diagonal(int row) const { return blocks_[row_begin_[row]]; }
  /// Diagonal block of a row, to be changed.
  Block6& Diagonal(int row) { return blocks_[row_begin_[row]]; }

  /// y = A x.
  void Multiply(const std::vector<Vector6>& x, std::vector<Vector6>* y) const;

 private:
  std::vector<int> row_begin_;
  std::vector<int> columns_;
  Blocks6 blocks_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_MATRIX_H_
