#include "splitfusion/lib/energy/bordered_matrix.h"

#include <algorithm>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

/// y += factor x
void AddScaled(double factor, const std::vector<Vector6>& x,
               std::vector<Vector6>* y) {
  splitfusion::AddScaled(6 * static_cast<int>(x.size()), factor,
                         x.data()->data(), y->data()->data());
}

}  // namespace

double Dot(const std::vector<Vector6>& a, const std::vector<Vector6>& b) {
  return DotProduct(6 * static_cast<int>(a.size()), a.data()->data(),
                    b.data()->data());
}

BorderedVector DiagonalOf(const BorderedMatrix& matrix) {
  BorderedVector diagonal{{}, matrix.corner.diagonal()};
  for (int i = 0; i < matrix.nodes.size(); ++i) {
    diagonal.nodes.push_back(matrix.nodes.Diagonal(i).diagonal());
  }
  return diagonal;
}

bool IsFinite(const BorderedVector& values) {
  return values.own.allFinite() &&
         std::all_of(values.nodes.begin(), values.nodes.end(),
                     [](const Vector6& v) { return v.allFinite(); });
}

void Multiply(const BorderedMatrix& matrix, const BorderedVector& x,
              BorderedVector* y) {
  y->nodes.resize(x.nodes.size());
  matrix.nodes.Multiply(x.nodes, &y->nodes);
  y->own = matrix.corner * x.own;
  for (std::size_t u = 0; u < matrix.border.size(); ++u) {
    AddScaled(x.own[u], matrix.border[u], &y->nodes);
    y->own[u] += Dot(matrix.border[u], x.nodes);
  }
}

ReducedMatrix::ReducedMatrix(const BorderedMatrix& matrix)
    : nodes_(matrix.nodes), corner_(matrix.corner), columns_(matrix.border) {
  const Eigen::MatrixXd l = corner_.matrixL();
  // L W^T = B^T by columns of W.
  for (std::size_t u = 0; u < columns_.size(); ++u) {
    for (std::size_t v = 0; v < u; ++v) {
      AddScaled(-l(u, v), columns_[v], &columns_[u]);
    }
    for (Vector6& block : columns_[u]) block /= l(u, u);
  }
}

Block6 ReducedMatrix::Diagonal(int row) const {
  Block6 block = nodes_.Diagonal(row);
  for (const auto& w : columns_) block -= w[row] * w[row].transpose();
  return block;
}

void ReducedMatrix::Multiply(const std::vector<Vector6>& x,
                             std::vector<Vector6>* y) const {
  nodes_.Multiply(x, y);
  for (const auto& w : columns_) AddScaled(-Dot(w, x), w, y);
}

std::vector<Vector6> ReducedMatrix::RightSide(const BorderedVector& b) const {
  std::vector<Vector6> right = b.nodes;
  const Eigen::VectorXd own = corner_.matrixL().solve(b.own);
  for (std::size_t u = 0; u < columns_.size(); ++u) {
    AddScaled(-own[u], columns_[u], &right);
  }
  return right;
}

Eigen::VectorXd ReducedMatrix::Own(const Eigen::VectorXd& b_own,
                                   const std::vector<Vector6>& x_nodes) const {
  Eigen::VectorXd own = corner_.matrixL().solve(b_own);
  for (std::size_t u = 0; u < columns_.size(); ++u) {
    own[u] -= Dot(columns_[u], x_nodes);
  }
  return corner_.matrixU().solve(own);
}

}  // namespace splitfusion
