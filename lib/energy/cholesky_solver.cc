#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <utility>

#include "splitfusion/lib/energy/block_kernels.h"
#include "splitfusion/lib/energy/linear_solver.h"
#include "splitfusion/lib/energy/node_order.h"

namespace splitfusion {
namespace {

using ScalarMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// The lower triangle of a block matrix with reordered nodes, for CHOLMOD.
class ReorderedMatrix {
 public:
  explicit ReorderedMatrix(const SymmetricBlockMatrix& matrix)
      : places_(OrderNodes(matrix)) {
    CollectColumns(matrix);
    const int size = 6 * matrix.size();
    values_.resize(size, size);
    values_.reserve(36 * matrix.block_count());
    for (int column = 0; column < size; ++column) {
      values_.startVec(column);
      for (const BlockPlace& place : columns_[column / 6]) {
        for (int row = 6 * place.row; row < 6 * place.row + 6; ++row) {
          if (row >= column) values_.insertBackByOuterInner(column, row) = 0;
        }
      }
    }
    values_.finalize();
  }

  /// The matrix with the values of `matrix`, which has the same pattern.
  const ScalarMatrix& Fill(const SymmetricBlockMatrix& matrix) {
    double* value = values_.valuePtr();
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      for (int c = 0; c < 6; ++c) {
        for (const BlockPlace& place : columns_[column]) {
          const Block6& block = matrix.blocks()[place.index];
          const bool diagonal = place.row == static_cast<int>(column);
          for (int r = diagonal ? c : 0; r < 6; ++r) {
            *value++ = place.transposed ? block(c, r) : block(r, c);
          }
        }
      }
    }
    return values_;
  }

  /// For every node its place in the matrix.
  const std::vector<int>& places() const { return places_; }

 private:
  /// Where a block of a column comes from.
  struct BlockPlace {
    int row;
    int index;
    bool transposed;
    bool operator<(const BlockPlace& other) const { return row < other.row; }
  };

  void CollectColumns(const SymmetricBlockMatrix& matrix) {
    columns_.resize(matrix.size());
    for (int i = 0; i < matrix.size(); ++i) {
      for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
        const int a = places_[i];
        const int b = places_[matrix.columns()[k]];
        columns_[std::min(a, b)].push_back({std::max(a, b), k, a < b});
      }
    }
    for (auto& column : columns_) std::sort(column.begin(), column.end());
  }

  std::vector<int> places_;
  std::vector<std::vector<BlockPlace>> columns_;  // By reordered node.
  ScalarMatrix values_;
};

/// |b - A x| / |b|
double RelativeResidual(const SymmetricBlockMatrix& a,
                        const std::vector<Vector6>& b,
                        const std::vector<Vector6>& x) {
  std::vector<Vector6> product(b.size());
  a.Multiply(x, &product);
  double squared = 0, norm = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    squared += (b[i] - product[i]).squaredNorm();
    norm += b[i].squaredNorm();
  }
  return norm > 0 ? std::sqrt(squared / norm) : 0;
}

class CholeskySolver : public LinearSolver {
 public:
  CholeskySolver() {
    // The nodes are ordered before.
    cholesky_.cholmod().nmethods = 1;
    cholesky_.cholmod().method[0].ordering = CHOLMOD_NATURAL;
    cholesky_.cholmod().print = 0;
  }

  LinearSolution Solve(const SymmetricBlockMatrix& a,
                       const std::vector<Vector6>& b,
                       std::vector<Vector6>* x) override {
    const bool first = matrix_ == nullptr;
    if (first) matrix_ = std::make_unique<ReorderedMatrix>(a);
    const ScalarMatrix& values = matrix_->Fill(a);
    if (first) cholesky_.analyzePattern(values);
    x->assign(b.size(), Vector6::Zero());
    cholesky_.factorize(values);
    if (cholesky_.info() != Eigen::Success) return {false, 1, 1};
    const std::vector<int>& places = matrix_->places();
    Eigen::VectorXd right(6 * b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
      right.segment<6>(6 * places[i]) = b[i];
    }
    const Eigen::VectorXd solution = cholesky_.solve(right);
    for (std::size_t i = 0; i < b.size(); ++i) {
      (*x)[i] = solution.segment<6>(6 * places[i]);
    }
    return {true, 1, RelativeResidual(a, b, *x)};
  }

 private:
  Eigen::CholmodSupernodalLLT<ScalarMatrix, Eigen::Lower> cholesky_;
  std::unique_ptr<ReorderedMatrix> matrix_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver() {
  return std::make_unique<CholeskySolver>();
}

}  // namespace splitfusion
