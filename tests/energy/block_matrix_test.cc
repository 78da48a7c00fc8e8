#include "splitfusion/lib/energy/block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <memory>
#include <string>

#include "splitfusion/lib/energy/linear_solver.h"
#include "splitfusion/lib/energy/pcg.h"
#include "support/expect_input_error.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

/// J^T J of a chain of nodes, and of one tie across; well conditioned.
class BlockMatrixTest : public ::testing::Test {
 protected:
  static constexpr int kNodes = 7;

  BlockMatrixTest()
      : matrix_(
            kNodes,
            {{0, 1}, {1, 2}, {2, 3}, {1, 2}, {3, 4}, {4, 5}, {5, 6}, {0, 6}}),
        dense_(Eigen::MatrixXd::Zero(6 * kNodes, 6 * kNodes)) {
    const auto random = RandomTwists(200, 1, /*seed=*/3);
    int next = 0;
    const auto vector = [&] {
      return Vector6(Eigen::Map<const Vector6>(random[next++].data()));
    };
    for (const auto& [a, b] :
         {std::pair(0, 1), {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {0, 6}}) {
      for (int row = 0; row < 8; ++row) AddRow(a, vector(), b, vector());
    }
  }

  void AddRow(int a, const Vector6& ja, int b, const Vector6& jb) {
    matrix_.Diagonal(a) += ja * ja.transpose();
    matrix_.Diagonal(b) += jb * jb.transpose();
    matrix_.blocks()[matrix_.Index(a, b)] += ja * jb.transpose();
    Eigen::VectorXd row = Eigen::VectorXd::Zero(6 * kNodes);
    row.segment<6>(6 * a) = ja;
    row.segment<6>(6 * b) = jb;
    dense_ += row * row.transpose();
  }

  static std::vector<Vector6> RandomVector(std::uint32_t seed) {
    std::vector<Vector6> x;
    for (const auto& values : RandomTwists(kNodes, 1, seed)) {
      x.emplace_back(values.data());
    }
    return x;
  }

  static Eigen::VectorXd Flat(const std::vector<Vector6>& x) {
    return Eigen::Map<const Eigen::VectorXd>(x[0].data(), 6 * kNodes);
  }

  SymmetricBlockMatrix matrix_;
  const ReducedMatrix reduced_{matrix_};
  Eigen::MatrixXd dense_;
};

TEST_F(BlockMatrixTest, StoresTheDiagonalAndEachPairOnce) {
  EXPECT_EQ(matrix_.size(), kNodes);
  EXPECT_EQ(matrix_.block_count(), static_cast<std::size_t>(kNodes + 7));
}

TEST_F(BlockMatrixTest, MultipliesLikeTheDenseMatrix) {
  const std::vector<Vector6> x = RandomVector(5);
  std::vector<Vector6> y(kNodes, Vector6::Constant(7));
  matrix_.Multiply(x, &y);
  EXPECT_LT((Flat(y) - dense_ * Flat(x)).norm(), 1e-12 * dense_.norm());
}

TEST_F(BlockMatrixTest, PcgSolvesToTheToleranceAsked) {
  const std::vector<Vector6> b = RandomVector(6);
  for (const double tolerance : {1e-2, 1e-6, 1e-10}) {
    std::vector<Vector6> x;
    const CgResult result =
        SolveByPcg(reduced_, MakePreconditioner("jacobi", reduced_), b,
                   tolerance, 500, &x);
    EXPECT_LE(result.relative_residual, tolerance);
    EXPECT_LE((dense_ * Flat(x) - Flat(b)).norm(),
              (1.001 * tolerance + 1e-12) * Flat(b).norm());
    EXPECT_LE(result.iterations, 6 * kNodes + 20);
  }
}

TEST_F(BlockMatrixTest, EveryPreconditionerLeadsToTheSolution) {
  const std::vector<Vector6> b = RandomVector(6);
  for (const char* name : {"identity", "jacobi"}) {
    std::vector<Vector6> x;
    const CgResult result = SolveByPcg(
        reduced_, MakePreconditioner(name, reduced_), b, 1e-10, 500, &x);
    EXPECT_LE((dense_ * Flat(x) - Flat(b)).norm(), 2e-10 * Flat(b).norm());
    EXPECT_LE(result.iterations, 6 * kNodes + 20);
  }
}

TEST_F(BlockMatrixTest, CholeskySolvesAndSaysWhereItCannot) {
  const auto solver = MakeCholeskySolver({});
  const BorderedVector b{RandomVector(6), Eigen::VectorXd(0)};
  BorderedMatrix matrix{matrix_, {}, Eigen::MatrixXd(0, 0)};
  BorderedVector x;
  for (const double factor : {1.0, 2.0}) {
    matrix.nodes.Diagonal(2).diagonal() *= factor;
    dense_.block<6, 6>(12, 12).diagonal() *= factor;
    const LinearSolution solution = solver->Solve(matrix, b, &x);
    EXPECT_TRUE(solution.usable);
    EXPECT_EQ(solution.iterations, 1);
    EXPECT_LT(solution.relative_residual, 1e-12);
    EXPECT_LT((dense_ * Flat(x.nodes) - Flat(b.nodes)).norm(),
              1e-12 * Flat(b.nodes).norm());
  }
  matrix.nodes.Diagonal(2) *= -1;
  EXPECT_FALSE(solver->Solve(matrix, b, &x).usable);
}

TEST_F(BlockMatrixTest, SolversSolveBorderedSystems) {
  // B = A E, C = E^T B + 1: positive definite, and far from block diagonal.
  BorderedMatrix matrix{matrix_, {}, Eigen::MatrixXd::Identity(2, 2)};
  const BorderedVector b{RandomVector(6), Eigen::Vector2d(3, -2)};
  Eigen::MatrixXd e(6 * kNodes, 2), whole(6 * kNodes + 2, 6 * kNodes + 2);
  for (int u = 0; u < 2; ++u) e.col(u) = Flat(RandomVector(20 + u));
  const Eigen::MatrixXd border = dense_ * e;
  for (int u = 0; u < 2; ++u) {
    matrix.border.emplace_back(kNodes);
    matrix_.Multiply(RandomVector(20 + u), &matrix.border.back());
  }
  matrix.corner += e.transpose() * border;
  whole << dense_, border, border.transpose(), matrix.corner;
  Eigen::VectorXd right(6 * kNodes + 2);
  right << Flat(b.nodes), b.own;
  const Eigen::VectorXd expected = whole.llt().solve(right);
  SolverOptions options;
  options.eta = 1e-13;
  options.max_linear_solver_iterations = 500;
  for (const bool direct : {false, true}) {
    const auto solver = direct ? MakeCholeskySolver({}) : MakePcgSolver(options);
    BorderedVector x;
    const LinearSolution solution = solver->Solve(matrix, b, &x);
    EXPECT_TRUE(solution.usable);
    EXPECT_LT(solution.relative_residual, 1e-11);
    Eigen::VectorXd found(6 * kNodes + 2);
    found << Flat(x.nodes), x.own;
    EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << direct;
  }
  matrix.corner(0, 0) *= -1;
  BorderedVector x;
  EXPECT_FALSE(MakeCholeskySolver({})->Solve(matrix, b, &x).usable);
  EXPECT_FALSE(MakePcgSolver(options)->Solve(matrix, b, &x).usable);
}

TEST_F(BlockMatrixTest, UnknownPreconditionersAreRefused) {
  ExpectInputError([&] { MakePreconditioner("ilu", reduced_); },
                   "preconditioner = ilu: expected auto, jacobi or identity");
}

TEST_F(BlockMatrixTest, PcgStopsAtItsIterations) {
  std::vector<Vector6> x;
  const CgResult result =
      SolveByPcg(reduced_, MakePreconditioner("jacobi", reduced_),
                 RandomVector(6), 1e-12, 3, &x);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_GT(result.relative_residual, 1e-12);
  EXPECT_LT(result.relative_residual, 10);
}

TEST_F(BlockMatrixTest, OneIterationSolvesWhatIsBlockDiagonal) {
  SymmetricBlockMatrix diagonal(kNodes, {});
  for (int i = 0; i < kNodes; ++i) diagonal.Diagonal(i) = matrix_.Diagonal(i);
  std::vector<Vector6> x;
  const ReducedMatrix same(diagonal);
  EXPECT_EQ(SolveByPcg(same, MakePreconditioner("jacobi", same),
                       RandomVector(8), 1e-9, 50, &x)
                .iterations,
            1);
}

TEST_F(BlockMatrixTest, ZeroAndUndefinedRightSidesEndAtOnce) {
  std::vector<Vector6> x;
  std::vector<Vector6> b(kNodes, Vector6::Zero());
  EXPECT_EQ(SolveByPcg(reduced_, MakePreconditioner("jacobi", reduced_), b,
                       1e-6, 50, &x)
                .iterations,
            0);
  EXPECT_EQ(Flat(x).norm(), 0);
  b[2][3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LE(SolveByPcg(reduced_, MakePreconditioner("jacobi", reduced_), b,
                       1e-6, 50, &x)
                .iterations,
            50);
}

}  // namespace
}  // namespace splitfusion
