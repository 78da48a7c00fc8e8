#include "splitfusion/lib/energy/block_matrix.h"

#include <algorithm>
#include <utility>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {

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

SymmetricBlockMatrix::SymmetricBlockMatrix(std::vector<int> row_begin,
                                           std::vector<int> columns)
    : row_begin_(std::move(row_begin)),
      columns_(std::move(columns)),
      blocks_(columns_.size(), Block6::Zero()) {}

int SymmetricBlockMatrix::Index(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_[row];
  const auto end = columns_.begin() + row_begin_[row + 1];
  return static_cast<int>(std::lower_bound(begin, end, column) -
                          columns_.begin());
}

void SymmetricBlockMatrix::Multiply(const std::vector<Vector6>& x,
                                    std::vector<Vector6>* y) const {
  MultiplySymmetric(size(), row_begin_.data(), columns_.data(),
                    blocks_.data()->data(), x.data()->data(),
                    y->data()->data());
}

}  // namespace splitfusion
