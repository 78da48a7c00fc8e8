#include "splitfusion/lib/energy/selected_inverse.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iterator>
#include <utility>

#include "splitfusion/lib/energy/node_order.h"

namespace splitfusion {
namespace {

/// The inverse of a symmetric block with its eigenvalues raised to `least`.
Block6 RaisedInverse(const Block6& block, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(
      block);
  const auto& vectors = solver.eigenvectors();
  return vectors *
         solver.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() *
         vectors.transpose();
}

}  // namespace

SelectedInverse::SelectedInverse(const SymmetricBlockMatrix& matrix,
                                 double least)
    : places_(OrderNodes(matrix)), columns_(matrix.size()) {
  CollectColumns(matrix);
  FillIn();
  CopyBlocks(matrix);
  for (int j = 0; j < matrix.size(); ++j) Eliminate(j, least);
  for (int j = matrix.size() - 1; j >= 0; --j) Invert(j);
}

void SelectedInverse::CollectColumns(const SymmetricBlockMatrix& matrix) {
  for (int i = 0; i < matrix.size(); ++i) {
    for (int k = matrix.row_begin()[i] + 1; k < matrix.row_begin()[i + 1];
         ++k) {
      const auto [low, high] =
          std::minmax(places_[i], places_[matrix.columns()[k]]);
      columns_[low].rows.push_back(high);
    }
  }
  for (Column& column : columns_) {
    std::sort(column.rows.begin(), column.rows.end());
  }
}

/// The rows of L: what a column ties together is tied in the column of its
/// first row, too.
void SelectedInverse::FillIn() {
  for (Column& column : columns_) {
    column.blocks.assign(column.rows.size(), Block6::Zero());
    if (column.rows.empty()) continue;
    std::vector<int>& next = columns_[column.rows.front()].rows;
    std::vector<int> merged;
    std::set_union(next.begin(), next.end(), column.rows.begin() + 1,
                   column.rows.end(), std::back_inserter(merged));
    next = std::move(merged);
  }
}

void SelectedInverse::CopyBlocks(const SymmetricBlockMatrix& matrix) {
  for (int i = 0; i < matrix.size(); ++i) {
    columns_[places_[i]].diagonal = matrix.Diagonal(i);
    for (int k = matrix.row_begin()[i] + 1; k < matrix.row_begin()[i + 1];
         ++k) {
      const int a = places_[i];
      const int b = places_[matrix.columns()[k]];
      // The stored block is that of (i, column).
      if (a > b) {
        Below(a, b) = matrix.blocks()[k];
      } else {
        Below(b, a) = matrix.blocks()[k].transpose();
      }
    }
  }
}

/// Takes L_j D_j L_j^T out of the columns that follow.
void SelectedInverse::Eliminate(int j, double least) {
  Column& column = columns_[j];
  column.diagonal = RaisedInverse(column.diagonal, least);
  for (std::size_t b = 0; b < column.rows.size(); ++b) {
    const Block6 scaled = column.diagonal * column.blocks[b].transpose();
    columns_[column.rows[b]].diagonal -= column.blocks[b] * scaled;
    for (std::size_t a = b + 1; a < column.rows.size(); ++a) {
      Below(column.rows[a], column.rows[b]) -= column.blocks[a] * scaled;
    }
  }
  for (Block6& block : column.blocks) block *= column.diagonal;
}

void SelectedInverse::Invert(int j) {
  Column& column = columns_[j];
  Blocks6 inverse(column.rows.size(), Block6::Zero());
  for (std::size_t a = 0; a < column.rows.size(); ++a) {
    for (std::size_t b = 0; b < column.rows.size(); ++b) {
      inverse[a] -= At(column.rows[a], column.rows[b]) * column.blocks[b];
    }
  }
  for (std::size_t a = 0; a < column.rows.size(); ++a) {
    column.diagonal -= inverse[a].transpose() * column.blocks[a];
  }
  column.blocks = std::move(inverse);
}

Block6& SelectedInverse::Below(int row, int column) {
  Column& place = columns_[column];
  const auto found =
      std::lower_bound(place.rows.begin(), place.rows.end(), row);
  return place.blocks[found - place.rows.begin()];
}

Block6 SelectedInverse::At(int row, int column) const {
  if (row == column) return columns_[row].diagonal;
  if (row < column) return At(column, row).transpose();
  const Column& place = columns_[column];
  const auto found =
      std::lower_bound(place.rows.begin(), place.rows.end(), row);
  return place.blocks[found - place.rows.begin()];
}

}  // namespace splitfusion
