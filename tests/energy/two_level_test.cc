#include "splitfusion/lib/energy/two_level.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/block_kernels.h"
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
  const CgResult result =
      SolveByPcg(matrix, preconditioner, b, 1e-6, 20000, &x);
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
  for (const auto& [patch, nodes] : members) {
    EXPECT_GE(3 * nodes.size(), static_cast<std::size_t>(kLargest));
    EXPECT_LE(nodes.size(), static_cast<std::size_t>(2 * kLargest));
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

TEST(MakePatches, WhatIsSmallAndAloneStaysAlone) {
  // A row of twelve, one pair and one node.
  Pairs pairs = {{12, 13}};
  for (int i = 0; i < 11; ++i) pairs.emplace_back(i, i + 1);
  const SymmetricBlockMatrix matrix(15, pairs);
  const NodePatches patches = MakePatches(matrix, GridCenters(1, 15), 12);
  std::vector<int> expected(12, 0);
  expected.insert(expected.end(), {1, 1, 2});
  EXPECT_EQ(patches.of_node, expected);
}

TEST(BlockKernels, AMatrixIsCarriedAsByDenseProducts) {
  const std::vector<int> patches = {2, 0, 1, 0, 2};
  const auto arms = GridCenters(1, 5);
  // A symmetric block for every pair that is there, of random numbers.
  SymmetricBlockMatrix matrix(5, {{0, 1}, {0, 4}, {1, 2}, {1, 3}, {2, 4}});
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(30, 30);
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(30, 18);
  SymmetricBlockMatrix coarse(3, {{0, 1}, {0, 2}, {1, 2}});
  std::vector<int> targets;
  for (int i = 0; i < 5; ++i) {
    for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
      const int j = matrix.columns()[k];
      const std::vector<Vector6> rows = RandomVector(6, /*seed=*/7 + k);
      Block6& block = matrix.blocks()[k];
      for (int r = 0; r < 6; ++r) block.row(r) = rows[r];
      if (i == j) block = (block + block.transpose()).eval();
      dense.block<6, 6>(6 * i, 6 * j) = block;
      dense.block<6, 6>(6 * j, 6 * i) = block.transpose();
      const auto [a, b] = std::minmax(patches[i], patches[j]);
      targets.push_back(coarse.Index(a, b));
    }
    // tau_i = tau_a + omega_a x arm
    auto own = p.block<6, 6>(6 * i, 6 * patches[i]);
    own.setIdentity();
    for (int axis = 0; axis < 3; ++axis) {
      own.block<3, 1>(3, axis) = Eigen::Vector3d::Unit(axis).cross(arms[i]);
    }
  }
  AddRigidlyCarried(5, matrix.row_begin().data(), matrix.columns().data(),
                    matrix.blocks().data()->data(), arms.data()->data(),
                    patches.data(), targets.data(),
                    coarse.blocks().data()->data());
  const Eigen::MatrixXd expected = p.transpose() * dense * p;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const Eigen::MatrixXd difference = coarse.blocks()[coarse.Index(a, b)] -
                                         expected.block<6, 6>(6 * a, 6 * b);
      EXPECT_LT(difference.norm(), 1e-12 * expected.norm()) << a << " " << b;
    }
  }
}

// One patch: what is added to block Jacobi is the best rigid motion of it.
TEST(TwoLevel, OnePatchIsCarriedAsARigidBody) {
  constexpr int kNodes = 12;
  const auto centers = GridCenters(3, 4);
  const SymmetricBlockMatrix matrix =
      HeldMatrix(GridPairs(3, 4), centers, /*held=*/2);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& center : centers) mean += center / kNodes;
  // Columns of P, and A P.
  std::vector<std::vector<Vector6>> p(6, std::vector<Vector6>(kNodes)), ap = p;
  for (int d = 0; d < 6; ++d) {
    for (int i = 0; i < kNodes; ++i) {
      p[d][i] = Vector6::Unit(d);
      if (d >= 3) continue;
      p[d][i].tail<3>() = Eigen::Vector3d::Unit(d).cross(centers[i] - mean);
    }
    matrix.Multiply(p[d], &ap[d]);
  }
  const std::vector<Vector6> x = RandomVector(kNodes, 6);
  Eigen::Matrix<double, 6, 6> coarse;
  Vector6 right;
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < 6; ++b) coarse(a, b) = Dot(p[a], ap[b]);
    right[a] = Dot(p[a], x);
  }
  const Vector6 motion = coarse.llt().solve(right);
  std::vector<Vector6> y(kNodes), expected(kNodes);
  TwoLevel(matrix, centers).Apply(x, &y);
  MakePreconditioner("jacobi", matrix, centers)->Apply(x, &expected);
  for (int i = 0; i < kNodes; ++i) {
    for (int d = 0; d < 6; ++d) expected[i] += motion[d] * p[d][i];
    EXPECT_LT((y[i] - expected[i]).norm(), 1e-5 * expected[i].norm());
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

// What holds the arm is far away from most of it: Jacobi takes more iterations
// to get there than the arm, of 480 nodes, has unknowns; two levels take 685.
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
  for (const int side : {3, 15}) {  // One patch, and many.
    const int nodes = side * side;
    const auto centers = GridCenters(side, side);
    const SymmetricBlockMatrix matrix =
        ArapMatrix(GridPairs(side, side), centers);
    const std::vector<Vector6> truth = RandomVector(nodes, 5);
    std::vector<Vector6> b(nodes), x;
    matrix.Multiply(truth, &b);
    const CgResult result =
        SolveByPcg(matrix, TwoLevel(matrix, centers), b, 1e-6, 500, &x);
    EXPECT_LE(result.relative_residual, 1e-6);
    EXPECT_LT(result.iterations, 150);
    // The rigid motion of all may be any, but none that is out of proportion.
    EXPECT_LT(Dot(x, x), 100 * Dot(truth, truth)) << side;
  }
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
