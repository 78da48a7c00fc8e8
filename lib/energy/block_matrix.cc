#include "splitfusion/lib/energy/block_matrix.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace splitfusion {
namespace {

double Dot(const std::vector<Vector6>& a, const std::vector<Vector6>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

SymmetricBlockMatrix::SymmetricBlockMatrix(
    int nodes, std::vector<std::pair<int, int>> pairs) {
  for (int i = 0; i < nodes; ++i) pairs.emplace_back(i, i);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  row_begin_.assign(nodes + 1, 0);
  columns_.reserve(pairs.size());
  for (const auto& [row, column] : pairs) {
    ++row_begin_[row + 1];
    columns_.push_back(column);
  }
  for (int i = 0; i < nodes; ++i) row_begin_[i + 1] += row_begin_[i];
  blocks_.assign(columns_.size(), Block6::Zero());
}

int SymmetricBlockMatrix::Index(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_[row];
  const auto end = columns_.begin() + row_begin_[row + 1];
  return static_cast<int>(std::lower_bound(begin, end, column) -
                          columns_.begin());
}

void SymmetricBlockMatrix::Multiply(const std::vector<Vector6>& x,
                                    std::vector<Vector6>* y) const {
  for (Vector6& value : *y) value.setZero();
  for (int row = 0; row < size(); ++row) {
    Vector6 sum = Diagonal(row) * x[row];
    for (int k = row_begin_[row] + 1; k < row_begin_[row + 1]; ++k) {
      const int column = columns_[k];
      sum.noalias() += blocks_[k] * x[column];
      (*y)[column].noalias() += blocks_[k].transpose() * x[row];
    }
    (*y)[row] += sum;
  }
}

CgResult SolveByPcg(const SymmetricBlockMatrix& a,
                    const std::vector<Vector6>& b, double tolerance,
                    int max_iterations, std::vector<Vector6>* x) {
  const std::size_t n = b.size();
  std::vector<Block6> inverse(n);
  for (std::size_t i = 0; i < n; ++i) {
    inverse[i] =
        a.Diagonal(static_cast<int>(i)).ldlt().solve(Block6::Identity());
  }
  const auto precondition = [&](const std::vector<Vector6>& in,
                                std::vector<Vector6>* out) {
    for (std::size_t i = 0; i < n; ++i)
      (*out)[i].noalias() = inverse[i] * in[i];
  };
  x->assign(n, Vector6::Zero());
  std::vector<Vector6> residual = b, z(n), direction(n), product(n);
  precondition(residual, &z);
  direction = z;
  double rz = Dot(residual, z);
  const double norm_b = std::sqrt(Dot(b, b));
  CgResult result;
  result.relative_residual = norm_b > 0 ? 1 : 0;
  while (result.iterations < max_iterations &&
         result.relative_residual > tolerance) {
    a.Multiply(direction, &product);
    const double curvature = Dot(direction, product);
    if (!(curvature > 0)) break;
    const double alpha = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      (*x)[i] += alpha * direction[i];
      residual[i] -= alpha * product[i];
    }
    precondition(residual, &z);
    const double next = Dot(residual, z);
    const double beta = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i) {
      direction[i] = z[i] + beta * direction[i];
    }
    ++result.iterations;
    result.relative_residual = std::sqrt(Dot(residual, residual)) / norm_b;
  }
  return result;
}

}  // namespace splitfusion
