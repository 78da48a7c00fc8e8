#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <string>
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
  ReorderedMatrix(const SymmetricBlockMatrix& matrix,
                  const std::string& ordering)
      : places_(OrderNodes(matrix, ordering)) {
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

/// |b - M x| / |b|
double RelativeResidual(const BorderedMatrix& m, const BorderedVector& b,
                        const BorderedVector& x) {
  BorderedVector product;
  Multiply(m, x, &product);
  double squared = 0, norm = 0;
  for (std::size_t i = 0; i < b.nodes.size(); ++i) {
    squared += (b.nodes[i] - product.nodes[i]).squaredNorm();
    norm += b.nodes[i].squaredNorm();
  }
  squared += (b.own - product.own).squaredNorm();
  norm += b.own.squaredNorm();
  return norm > 0 ? std::sqrt(squared / norm) : 0;
}

class CholeskySolver : public LinearSolver {
 public:
  explicit CholeskySolver(std::string ordering)
      : ordering_(std::move(ordering)) {
    // The nodes are ordered before.
    cholesky_.cholmod().nmethods = 1;
    cholesky_.cholmod().method[0].ordering = CHOLMOD_NATURAL;
    cholesky_.cholmod().print = 0;
  }

  /// Of [A B; B^T C] A is factorised: with Z = A^-1 [B b_nodes] the own
  /// unknowns solve (C - B^T Z_B) x_own = b_own - B^T z_b, and x_nodes are
  /// z_b - Z_B x_own.
  LinearSolution Solve(const BorderedMatrix& m, const BorderedVector& b,
                       BorderedVector* x) override {
    const bool first = matrix_ == nullptr;
    if (first) {
      matrix_ = std::make_unique<ReorderedMatrix>(m.nodes, ordering_);
    }
    const ScalarMatrix& values = matrix_->Fill(m.nodes);
    if (first) cholesky_.analyzePattern(values);
    x->nodes.assign(b.nodes.size(), Vector6::Zero());
    x->own.setZero(b.own.size());
    cholesky_.factorize(values);
    if (cholesky_.info() != Eigen::Success) return {false, 1, 1};
    const Eigen::Index own = b.own.size();
    Eigen::MatrixXd right(6 * b.nodes.size(), own + 1);
    for (Eigen::Index u = 0; u < own; ++u)
      right.col(u) = Reordered(m.border[u]);
    right.col(own) = Reordered(b.nodes);
    const Eigen::MatrixXd z = cholesky_.solve(right);
    const auto border = right.leftCols(own);
    const Eigen::LLT<Eigen::MatrixXd> corner(m.corner - border.transpose() *
                                                            z.leftCols(own));
    if (corner.info() != Eigen::Success) return {false, 1, 1};
    x->own = corner.solve(b.own - border.transpose() * z.col(own));
    const Eigen::VectorXd solution = z.col(own) - z.leftCols(own) * x->own;
    const std::vector<int>& places = matrix_->places();
    for (std::size_t i = 0; i < places.size(); ++i) {
      x->nodes[i] = solution.segment<6>(6 * places[i]);
    }
    return {true, 1, RelativeResidual(m, b, *x)};
  }

 private:
  Eigen::VectorXd Reordered(const std::vector<Vector6>& nodes) const {
    Eigen::VectorXd reordered(6 * nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      reordered.segment<6>(6 * matrix_->places()[i]) = nodes[i];
    }
    return reordered;
  }

  std::string ordering_;
  Eigen::CholmodSupernodalLLT<ScalarMatrix, Eigen::Lower> cholesky_;
  std::unique_ptr<ReorderedMatrix> matrix_;
};

}  // namespace

std::unique_ptr<LinearSolver> MakeCholeskySolver(const SolverOptions& options) {
  return std::make_unique<CholeskySolver>(options.ordering);
}

}  // namespace splitfusion
