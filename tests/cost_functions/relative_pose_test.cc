#include "splitfusion/cost_functions/relative_pose.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <vector>

#include "support/gradient_check.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

using Residual = Eigen::Matrix<double, 3, 4>;
using Twist = std::vector<double>;

const Twist kZero(6, 0.0);

TypicalPoints SomePoints() {
  return TypicalPointsOf(
      {{0.3f, -0.2f, 2}, {-0.5f, 0.4f, 1.5f}, {0, 0.1f, 3}, {0.2f, 0.3f, 2}});
}

Residual Value(const RelativePose& edge, const Twist& from, const Twist& to) {
  Residual residual;
  edge(from.data(), to.data(), residual.data());
  return residual;
}

/// The twist applied to `pose`, X T of RelativePose.
Rigid3d Moved(const Twist& twist, const Rigid3d& pose) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = ExpSo3({twist[0], twist[1], twist[2]});
  motion.translation() << twist[3], twist[4], twist[5];
  return motion * pose;
}

TEST(RelativePose, IsHalfTheWayOfEveryPoint) {
  const Rigid3d measured(Eigen::Translation3d(0, 0, 0.1));
  const RelativePose edge(Rigid3d::Identity(), measured, SomePoints());
  Residual expected = Residual::Zero();
  expected.row(2).setConstant(-0.05);
  EXPECT_TRUE(Value(edge, kZero, kZero).isApprox(expected, 1e-12));
  EXPECT_NEAR(expected.norm(), 0.1, 1e-12);  // Root mean square of all.
  // A twist of j moves them there, one of i away.
  EXPECT_LT(Value(edge, kZero, {0, 0, 0, 0, 0, 0.1}).norm(), 1e-12);
  EXPECT_NEAR(Value(edge, {0, 0, 0, 0, 0, 0.1}, kZero).norm(), 0.2, 1e-12);
}

TEST(RelativePose, IsZeroAtConsistentPosesWhateverTheWorld) {
  const Rigid3d i = MakeMotion({0.3, -1, 0.2}, {0.5, 0, -1});
  const Rigid3d j = MakeMotion({-0.1, 0.4, 1}, {0, 0.7, 0.2});
  const Twist from = {0.1, 0.2, -0.1, 0.3, 0, 0.1};
  const Twist to = {-0.2, 0.1, 0, 0, 0.2, -0.3};
  const Rigid3d measured = Moved(to, j) * Moved(from, i).inverse();
  for (const Rigid3d& world :
       {Rigid3d(Rigid3d::Identity()), MakeMotion({2, 0, 1}, {5, 6, 7})}) {
    const Rigid3d before = (j * world) * (i * world).inverse();
    const RelativePose edge(before, measured, SomePoints());
    EXPECT_LT(Value(edge, from, to).norm(), 1e-12);
    EXPECT_GT(Value(edge, kZero, to).norm(), 0.1);
  }
}

TEST(RelativePose, GradientsMatchNumeric) {
  const Rigid3d before = MakeMotion({0.3, -1, 0.2}, {0.5, 0, -1});
  const Rigid3d measured = MakeMotion({0.2, -1.1, 0.2}, {0.4, 0, -1});
  const ceres::AutoDiffCostFunction<RelativePose, 12, 6, 6> cost(
      new RelativePose(before, measured, SomePoints()));
  for (const double size : {0.0, 0.01, 0.3}) {
    EXPECT_GRADIENTS_MATCH(cost, RandomTwists(2, size, /*seed=*/3));
  }
}

}  // namespace
}  // namespace splitfusion
