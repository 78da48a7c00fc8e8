#include "splitfusion/lib/energy/two_level.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/pcg.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

constexpr double kSpacing = 0.04;

using Pairs = std::vector<std::pair<int, int>>;

/// Neighbours of a grid of nodes `columns` wide.
Pairs GridPairs(int rows, int columns) {
  Pairs pairs;
  for (int i = 0; i < rows * columns; ++i) {
    if ((i + 1) % columns != 0) pairs.emplace_back(i, i + 1);
    if (i + columns < rows * columns) pairs.emplace_back(i, i + columns);
  }
  return pairs;
}

std::vector<Eigen::Vector3d> GridCenters(int rows, int columns) {
  std::vector<Eigen::Vector3d> centers;
  for (int i = 0; i < rows * columns; ++i) {
    centers.push_back(kSpacing *
                      Eigen::Vector3d(i % columns, i / columns, 0.1 * (i % 3)));
  }
  return centers;
}

/// Derivatives of Eq. 6 by the twist of a node at the start of an edge.
Eigen::Matrix<double, 3, 6> EdgeStart(const Eigen::Vector3d& edge) {
  Eigen::Matrix<double, 3, 6> jacobian;
  jacobian << 0, -edge.z(), edge.y(), 1, 0, 0,  //
      edge.z(), 0, -edge.x(), 0, 1, 0,          //
      -edge.y(), edge.x(), 0, 0, 0, 1;
  return jacobian;
}

/// J^T J of ARAP over the pairs, in both directions.
SymmetricBlockMatrix ArapMatrix(const Pairs& pairs,
                                const std::vector<Eigen::Vector3d>& centers) {
  SymmetricBlockMatrix matrix(static_cast<int>(centers.size()), pairs);
  Eigen::Matrix<double, 3, 6> end = Eigen::Matrix<double, 3, 6>::Zero();
  end.rightCols<3>() = -Eigen::Matrix3d::Identity();
  for (const auto& [i, j] : pairs) {
    const auto there = EdgeStart(centers[i] - centers[j]);
    const auto back = EdgeStart(centers[j] - centers[i]);
    matrix.Diagonal(i) += there.transpose() * there + end.transpose() * end;
    matrix.Diagonal(j) += back.transpose() * back + end.transpose() * end;
    matrix.blocks()[matrix.Index(i, j)] +=
        there.transpose() * end + end.transpose() * back;
  }
  return matrix;
}

/// The same with a little damping; the first `held` nodes are held as well.
SymmetricBlockMatrix HeldMatrix(const Pairs& pairs,
                                const std::vector<Eigen::Vector3d>& centers,
                                int held) {
  SymmetricBlockMatrix matrix = ArapMatrix(pairs, centers);
  for (int i = 0; i < matrix.size(); ++i) {
    const Vector6 diagonal = matrix.Diagonal(i).diagonal();
    matrix.Diagonal(i).diagonal() += 1e-6 * diagonal;
    if (i < held) matrix.Diagonal(i).diagonal().array() += 10;
  }
  return matrix;
}

std::vector<Vector6> RandomVector(int size, std::uint32_t seed) {
  std::vector<Vector6> x;
  for (const auto& values : RandomTwists(size, 1, seed)) {
    x.emplace_back(values.data());
  }
  return x;
}

double Dot(const std::vector<Vector6>& a, const std::vector<Vector6>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Iterations to a millionth of a system that is then solved.
int Iterations(const SymmetricBlockMatrix& matrix,
               const Preconditioner& preconditioner) {
  const std::vector<Vector6> b = RandomVector(matrix.size(), /*seed=*/4);
  std::vector<Vector6> x;
  const CgResult result = SolveByPcg(matrix, preconditioner, b, 1e-6, 5000, &x);
  EXPECT_LE(result.relative_residual, 1e-6);
  std::vector<Vector6> product(b.size());
  matrix.Multiply(x, &product);
  for (std::size_t i = 0; i < b.size(); ++i) product[i] -= b[i];
  EXPECT_LE(Dot(product, product), 1e-10 * Dot(b, b));
  return result.iterations;
}

TEST(MakePatches, AreConnectedAndCoverAllNodes) {
  constexpr int kRows = 17, kColumns = 23, kLargest = 12;
  Pairs pairs = GridPairs(kRows, kColumns);
  const SymmetricBlockMatrix matrix(kRows * kColumns, pairs);
  const auto centers = GridCenters(kRows, kColumns);
  const NodePatches patches = MakePatches(matrix, centers, kLargest);
  std::map<int, std::set<int>> members;
  for (int i = 0; i < matrix.size(); ++i) members[patches.of_node[i]].insert(i);
  ASSERT_EQ(static_cast<int>(members.size()), patches.size());
  EXPECT_GE(patches.size(), matrix.size() / (2 * kLargest));
  EXPECT_LE(patches.size(), matrix.size() / (kLargest / 3));
  for (const auto& [patch, nodes] : members) {
    EXPECT_GE(3 * nodes.size(), static_cast<std::size_t>(kLargest));
    std::set<int> reached = {*nodes.begin()};
    for (std::size_t before = 0; before != reached.size();) {
      before = reached.size();
      for (const auto& [i, j] : pairs) {
        if (nodes.count(i) == 0 || nodes.count(j) == 0) continue;
        if (reached.count(i) + reached.count(j) == 1) reached.insert({i, j});
      }
    }
    EXPECT_EQ(reached, nodes) << "patch " << patch;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int i : nodes) mean += centers[i] / nodes.size();
    EXPECT_LT((patches.centers[patch] - mean).norm(), 1e-12);
  }
}

TEST(TwoLevel, IsSymmetricAndPositive) {
  const auto centers = GridCenters(20, 30);
  const TwoLevel preconditioner(
      HeldMatrix(GridPairs(20, 30), centers, /*held=*/5), centers);
  const std::vector<Vector6> a = RandomVector(600, 1), b = RandomVector(600, 2);
  std::vector<Vector6> ma(600), mb(600);
  const double aa = preconditioner.Apply(a, &ma);
  const double bb = preconditioner.Apply(b, &mb);
  EXPECT_NEAR(aa, Dot(a, ma), 1e-12 * aa);
  EXPECT_NEAR(bb, Dot(b, mb), 1e-12 * bb);
  EXPECT_GT(aa, 0);
  EXPECT_GT(bb, 0);
  EXPECT_NEAR(Dot(a, mb), Dot(b, ma), 1e-9 * std::sqrt(aa * bb));
}

// What holds the arm is far away from most of it: Jacobi takes 4267 iterations
// to get there, as many as the arm has nodes and more.
TEST(TwoLevel, TheEndOfALongArmIsReachedSooner) {
  constexpr int kLength = 160, kWidth = 3;
  const auto centers = GridCenters(kLength, kWidth);
  const SymmetricBlockMatrix matrix =
      HeldMatrix(GridPairs(kLength, kWidth), centers, /*held=*/kWidth);
  const int jacobi =
      Iterations(matrix, *MakePreconditioner("jacobi", matrix, centers));
  EXPECT_LT(5 * Iterations(matrix, TwoLevel(matrix, centers)), jacobi);
}

// Without damping a part that nothing holds has no stiffness at all.
TEST(TwoLevel, WhatNothingHoldsIsNoMatter) {
  const auto centers = GridCenters(15, 15);
  const SymmetricBlockMatrix matrix = ArapMatrix(GridPairs(15, 15), centers);
  std::vector<Vector6> b(225), x;
  matrix.Multiply(RandomVector(225, 5), &b);
  const CgResult result =
      SolveByPcg(matrix, TwoLevel(matrix, centers), b, 1e-6, 500, &x);
  EXPECT_LE(result.relative_residual, 1e-6);
  EXPECT_LT(result.iterations, 150);
  for (const Vector6& v : x) EXPECT_TRUE(v.allFinite());
}

TEST(TwoLevel, OneIterationSolvesWhatIsNotJoined) {
  constexpr int kNodes = 100;
  SymmetricBlockMatrix matrix(kNodes, {});
  for (int i = 0; i < kNodes; ++i) {
    const Eigen::Matrix<double, 3, 6> rows =
        EdgeStart(Eigen::Vector3d(0.1 * i, 1, 2));
    matrix.Diagonal(i) = rows.transpose() * rows;
    matrix.Diagonal(i).diagonal().array() += 0.5;
  }
  EXPECT_EQ(Iterations(matrix, TwoLevel(matrix, GridCenters(10, 10))), 1);
}

}  // namespace
}  // namespace splitfusion
