#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_PATTERN_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_PATTERN_H_

#include <cstddef>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// Which nodes share residuals, where the values of each block of residuals are
/// kept, and how they sum to the normal equations.
class BlockPattern {
 public:
  /// One block of residuals over n nodes and, where its terms have some, own
  /// unknowns of these. Its values, at `offset`: its gradient (6n numbers), J^T
  /// times the derivative by each such unknown (6n numbers each), then its
  /// Jacobian J by rows (rows x 6n), or, if `summed`, its J_k^T J_l for all k
  /// <= l (36 numbers each, ascending by k, then l).
  struct Block {
    int first = 0;           ///< Of its nodes.
    int count = 0;           ///< n
    int rows = 0;            ///< Scalar residuals.
    int unknowns = 0;        ///< Number of own unknowns.
    int first_unknown = 0;   ///< Of its list of these.
    bool summed = false;     ///< See above.
    std::size_t offset = 0;  ///< Of its values.

    /// Where the Jacobian or the sums begin.
    std::size_t matrix_offset() const {
      return offset + 6 * count * (1 + unknowns);
    }
    /// Numbers that they take.
    std::size_t matrix_size() const {
      return summed ? 18 * count * (count + 1) : 6 * count * rows;
    }
  };

  /// Adds a block. `nodes` are ascending; `unknowns`: its columns in B;
  /// `may_sum`: it can be summed, and will be where that takes less room.
  void Add(const int* nodes, int count, int rows,
           const std::vector<int>& unknowns, bool may_sum);

  /// To be called after the last Add(): the matrix over so many nodes.
  void Finish(int nodes);

  /// Blocks in the order added.
  const std::vector<Block>& blocks() const { return blocks_; }
  /// Nodes of a block, ascending.
  const int* nodes(const Block& block) const { return &nodes_[block.first]; }
  /// Room that the values of all blocks take.
  std::size_t value_count() const { return value_count_; }

  /// Matrix with a 6x6 block wherever two nodes share a block; zero.
  SymmetricBlockMatrix MakeMatrix() const;

  /// Sums the blocks' values to J^T J, J^T r and B (by columns, as many as it
  /// has), row by row in parallel and in the order of the blocks. `matrix` is
  /// one of MakeMatrix().
  void Assemble(const double* values, SymmetricBlockMatrix* matrix,
                std::vector<Vector6>* gradient,
                std::vector<std::vector<Vector6>>* border) const;

 private:
  /// A block that a node has part in.
  struct Incidence {
    int block;
    int rank;   // Of the node among the block's.
    int slots;  // Where its places in the matrix row begin.
  };

  void CollectIncidences(int nodes);
  void CollectRow(int row, std::vector<int>* stamps);
  void AddBorder(const Incidence& incidence, const double* values, int row,
                 std::vector<std::vector<Vector6>>* border) const;
  void AddToRow(const Incidence& incidence, const double* values,
                double* row) const;

  std::vector<Block> blocks_;
  std::vector<int> nodes_;
  std::vector<int> unknowns_;  // Lists of the blocks.
  std::size_t value_count_ = 0;
  std::vector<int> incidence_begin_;  // By node.
  std::vector<Incidence> incidences_;
  std::vector<int> slots_;      // Places of a block's nodes in a matrix row.
  std::vector<int> row_begin_;  // Of the matrix.
  std::vector<int> columns_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_PATTERN_H_
