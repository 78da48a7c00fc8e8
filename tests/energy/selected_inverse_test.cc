#include "splitfusion/lib/energy/selected_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <set>
#include <utility>

namespace splitfusion {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// J^T J of ten random residuals a pair of nodes.
SymmetricBlockMatrix RandomMatrix(int nodes, const Pairs& pairs) {
  SymmetricBlockMatrix matrix(nodes, pairs);
  std::mt19937 random(1);
  const auto number = [&](Eigen::Index) { return random() / 2147483648.0 - 1; };
  for (const auto& [i, j] : pairs) {
    const Eigen::Matrix<double, 10, 6> a =
        Eigen::Matrix<double, 10, 6>::NullaryExpr(
            10, 6, [&](auto, auto) { return number(0); });
    const Eigen::Matrix<double, 10, 6> b =
        Eigen::Matrix<double, 10, 6>::NullaryExpr(
            10, 6, [&](auto, auto) { return number(0); });
    matrix.Diagonal(i) += a.transpose() * a;
    matrix.Diagonal(j) += b.transpose() * b;
    matrix.blocks()[matrix.Index(i, j)] += a.transpose() * b;
  }
  return matrix;
}

Eigen::MatrixXd Dense(const SymmetricBlockMatrix& matrix) {
  Eigen::MatrixXd dense =
      Eigen::MatrixXd::Zero(6 * matrix.size(), 6 * matrix.size());
  for (int i = 0; i < matrix.size(); ++i) {
    for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
      const int j = matrix.columns()[k];
      dense.block<6, 6>(6 * i, 6 * j) = matrix.blocks()[k];
      dense.block<6, 6>(6 * j, 6 * i) = matrix.blocks()[k].transpose();
    }
  }
  return dense;
}

/// A ring of nodes with some chords, so that much fills in.
Pairs Ring(int nodes) {
  Pairs pairs;
  for (int i = 0; i < nodes; ++i) {
    pairs.push_back(std::minmax(i, (i + 1) % nodes));
    if (i % 3 == 0) pairs.push_back(std::minmax(i, (i + nodes / 2) % nodes));
  }
  return pairs;
}

TEST(SelectedInverse, IsTheDenseInverseWhereTheMatrixHasBlocks) {
  const Pairs pairs = Ring(20);
  const SymmetricBlockMatrix matrix = RandomMatrix(20, pairs);
  const Eigen::MatrixXd expected = Dense(matrix).inverse();
  const SelectedInverse inverse(matrix, 1e-9);
  const double rounding = 1e-10 * expected.cwiseAbs().maxCoeff();
  for (const auto& [i, j] : pairs) {
    for (const auto& [a, b] : {std::pair(i, j), std::pair(j, i)}) {
      const Eigen::MatrixXd block = expected.block<6, 6>(6 * a, 6 * b);
      EXPECT_LT((inverse.Block(a, b) - block).cwiseAbs().maxCoeff(), rounding);
    }
  }
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd block = expected.block<6, 6>(6 * i, 6 * i);
    EXPECT_LT((inverse.Block(i, i) - block).cwiseAbs().maxCoeff(), rounding);
  }
}

TEST(SelectedInverse, WhatNothingHoldsHasTheGreatestVariance) {
  // Node 2 is tied to nothing, node 3 held in its last direction alone.
  SymmetricBlockMatrix matrix(4, {{0, 1}});
  const SymmetricBlockMatrix held = RandomMatrix(2, {{0, 1}});
  matrix.Diagonal(0) = held.Diagonal(0);
  matrix.Diagonal(1) = held.Diagonal(1);
  matrix.blocks()[matrix.Index(0, 1)] = held.blocks()[held.Index(0, 1)];
  matrix.Diagonal(0).diagonal().array() += 1;  // Ten rows hold one node alone.
  matrix.Diagonal(1).diagonal().array() += 1;
  matrix.Diagonal(3)(5, 5) = 100;
  const Eigen::MatrixXd expected =
      Dense(matrix).topLeftCorner<12, 12>().inverse();
  const SelectedInverse inverse(matrix, 0.01);
  EXPECT_LT((inverse.Block(0, 0) - expected.topLeftCorner<6, 6>()).norm(),
            1e-10);
  EXPECT_LT((inverse.Block(2, 2) - 100 * Block6::Identity()).norm(), 1e-10);
  EXPECT_NEAR(inverse.Block(3, 3)(5, 5), 0.01, 1e-12);
  EXPECT_NEAR(inverse.Block(3, 3)(0, 0), 100, 1e-10);
}

}  // namespace
}  // namespace splitfusion
