#include "splitfusion/lib/energy/block_pattern.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {

void BlockPattern::Add(const int* nodes, int count, int rows,
                       const std::vector<int>& unknowns, bool may_sum) {
  Block block;
  block.first = static_cast<int>(nodes_.size());
  block.count = count;
  block.rows = rows;
  block.unknowns = static_cast<int>(unknowns.size());
  block.first_unknown = static_cast<int>(unknowns_.size());
  block.summed = may_sum && rows > 3 * (count + 1);
  block.offset = value_count_;
  nodes_.insert(nodes_.end(), nodes, nodes + count);
  unknowns_.insert(unknowns_.end(), unknowns.begin(), unknowns.end());
  value_count_ = block.matrix_offset() + block.matrix_size();
  blocks_.push_back(block);
}

void BlockPattern::Finish(int nodes) {
  CollectIncidences(nodes);
  std::vector<int> stamps(nodes, -1);
  row_begin_.assign(1, 0);
  for (int row = 0; row < nodes; ++row) CollectRow(row, &stamps);
}

void BlockPattern::CollectIncidences(int nodes) {
  incidence_begin_.assign(nodes + 1, 0);
  for (const int node : nodes_) ++incidence_begin_[node + 1];
  for (int i = 0; i < nodes; ++i)
    incidence_begin_[i + 1] += incidence_begin_[i];
  std::vector<int> next(incidence_begin_.begin(), incidence_begin_.end() - 1);
  incidences_.resize(nodes_.size());
  int slots = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (int k = 0; k < blocks_[b].count; ++k) {
      const int node = nodes_[blocks_[b].first + k];
      incidences_[next[node]++] = {static_cast<int>(b), k, slots};
      slots += blocks_[b].count - k;
    }
  }
  slots_.resize(slots);
}

void BlockPattern::CollectRow(int row, std::vector<int>* stamps) {
  const auto begin = incidences_.begin() + incidence_begin_[row];
  const auto end = incidences_.begin() + incidence_begin_[row + 1];
  const int first = row_begin_.back();
  (*stamps)[row] = first;
  columns_.push_back(row);
  for (auto it = begin; it != end; ++it) {
    const Block& block = blocks_[it->block];
    for (int k = it->rank + 1; k < block.count; ++k) {
      const int column = nodes_[block.first + k];
      if ((*stamps)[column] >= first) continue;
      (*stamps)[column] = first;
      columns_.push_back(column);
    }
  }
  std::sort(columns_.begin() + first + 1, columns_.end());
  const int last = static_cast<int>(columns_.size());
  for (int i = first; i < last; ++i) (*stamps)[columns_[i]] = i;
  for (auto it = begin; it != end; ++it) {
    const Block& block = blocks_[it->block];
    int* slot = &slots_[it->slots];
    for (int k = it->rank; k < block.count; ++k) {
      *slot++ = (*stamps)[nodes_[block.first + k]] - first;
    }
  }
  row_begin_.push_back(last);
}

SymmetricBlockMatrix BlockPattern::MakeMatrix() const {
  return SymmetricBlockMatrix(row_begin_, columns_);
}

void BlockPattern::Assemble(const double* values, SymmetricBlockMatrix* matrix,
                            std::vector<Vector6>* gradient,
                            std::vector<std::vector<Vector6>>* border) const {
  const int size = matrix->size();
  gradient->assign(size, Vector6::Zero());
  for (auto& column : *border) column.assign(size, Vector6::Zero());
  tbb::parallel_for(
      tbb::blocked_range<int>(0, size, 16),
      [&](const tbb::blocked_range<int>& range) {
        for (int i = range.begin(); i < range.end(); ++i) {
          double* row = matrix->Diagonal(i).data();
          std::fill_n(row, 36 * (row_begin_[i + 1] - row_begin_[i]), 0.0);
          for (int n = incidence_begin_[i]; n < incidence_begin_[i + 1]; ++n) {
            const Incidence& incidence = incidences_[n];
            AddToRow(incidence, values, row);
            (*gradient)[i] += Eigen::Map<const Vector6>(
                values + blocks_[incidence.block].offset + 6 * incidence.rank);
            AddBorder(incidence, values, i, border);
          }
        }
      });
}

void BlockPattern::AddBorder(const Incidence& incidence, const double* values,
                             int row,
                             std::vector<std::vector<Vector6>>* border) const {
  const Block& block = blocks_[incidence.block];
  const double* column = values + block.offset + 6 * incidence.rank;
  for (int u = 0; u < block.unknowns; ++u) {
    column += 6 * block.count;
    (*border)[unknowns_[block.first_unknown + u]][row] +=
        Eigen::Map<const Vector6>(column);
  }
}

void BlockPattern::AddToRow(const Incidence& incidence, const double* values,
                            double* row) const {
  const Block& block = blocks_[incidence.block];
  const double* matrix = values + block.matrix_offset();
  const int* slots = &slots_[incidence.slots];
  const int rank = incidence.rank;
  if (!block.summed) {
    AddOuterProducts(matrix, block.rows, block.count, rank, slots, row);
    return;
  }
  // Blocks (k, l) before those of this rank.
  matrix += 36 * (rank * block.count - rank * (rank - 1) / 2);
  for (int l = 0; l < block.count - rank; ++l, matrix += 36) {
    double* out = row + 36 * slots[l];
    for (int e = 0; e < 36; ++e) out[e] += matrix[e];
  }
}

}  // namespace splitfusion
