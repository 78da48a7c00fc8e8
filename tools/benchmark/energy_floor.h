#ifndef SPLITFUSION_TOOLS_BENCHMARK_ENERGY_FLOOR_H_
#define SPLITFUSION_TOOLS_BENCHMARK_ENERGY_FLOOR_H_

#include <tbb/cache_aligned_allocator.h>

#include <utility>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// Numbers, aligned for wide vectors.
using FloorArray = std::vector<double, tbb::cache_aligned_allocator<double>>;

/// Rows of a Jacobian in groups that share their nodes.
struct FloorRows {
  /// Adds a group; `group_rows`: 6n numbers a row.
  void Add(const std::vector<int>& group_nodes,
           const std::vector<double>& group_rows,
           const std::vector<double>& group_residuals);

  int nodes_per_row = 0;      ///< n, 2 or 6.
  std::vector<int> nodes;     ///< By group, ascending within.
  std::vector<int> begin{0};  ///< First row of every group, and the end.
  FloorArray rows;            ///< 6n numbers a row.
  FloorArray residuals;       ///< One a row.
  std::vector<int> slots;     ///< Blocks (k, l >= k) in the matrix, by group.

  /// Number of groups.
  int groups() const { return static_cast<int>(begin.size()) - 1; }
};

/// Upper triangle of the normal equations by rows, the diagonal first.
struct FloorMatrix {
  std::vector<int> row_begin;  ///< First block of every row, and the end.
  std::vector<int> columns;    ///< Of the blocks.
  FloorArray blocks;           ///< 36 numbers a block, by rows.
  FloorArray gradient;         ///< J^T r, six numbers a row.

  /// Number of block rows.
  int size() const { return static_cast<int>(row_begin.size()) - 1; }
};

/// The barest iteration: given the rows of the Jacobian, sum them to normal
/// equations and solve these by conjugate gradients with block Jacobi. No
/// residual is evaluated, no cost, no trial step.
class EnergyFloor {
 public:
  /// `pattern`: a matrix with the blocks that the rows have; `points`: n = 6;
  /// `edges`: n = 2. Places the blocks.
  EnergyFloor(const SymmetricBlockMatrix& pattern, FloorRows points,
              FloorRows edges);

  /// Sums the rows to J^T J and J^T r; a share of the groups a thread.
  void Assemble();
  /// Adds max(diagonal, 1e-6) / radius to the diagonal.
  void Damp(double radius);
  /// Preconditioned conjugate gradients, the inverse diagonal blocks before
  /// them; returns the number of products.
  int Solve(double tolerance, int max_iterations);

  /// Sums of the last Assemble(), damped by Damp().
  const FloorMatrix& matrix() const { return shares_[0]; }
  /// Of the last Solve(): (J^T J) x = -J^T r.
  const FloorArray& solution() const { return x_; }

 private:
  void PlaceBlocks(FloorRows* rows) const;

  FloorRows points_;
  FloorRows edges_;
  std::vector<FloorMatrix> shares_;  // A thread's sums; the first has them all.
  FloorArray inverse_;               // Of the diagonal blocks.
  FloorArray x_, r_, z_, d_, q_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_ENERGY_FLOOR_H_
