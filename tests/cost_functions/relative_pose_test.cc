#include "splitfusion/cost_functions/relative_pose.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <vector>

#include "support/gradient_check.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

using EdgeResidual = Eigen::Matrix<double, 3, 4>;
using EdgeTwist = std::vector<double>;

const EdgeTwist kNoTwist(6, 0.0);

TypicalPoints SomePoints() {
  return TypicalPointsOf(
      {{0.3f, -0.2f, 2}, {-0.5f, 0.4f, 1.5f}, {0, 0.1f, 3}, {0.2f, 0.3f, 2}});
}

EdgeResidual EdgeValue(const RelativePose& edge, const EdgeTwist& from,
                       const EdgeTwist& to) {
  EdgeResidual residual;
  edge(from.data(), to.data(), residual.data());
  return residual;
}

/// The twist applied to `pose`, X T of RelativePose.
Rigid3d MovedPose(const EdgeTwist& twist, const Rigid3d& pose) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = ExpSo3({twist[0], twist[1], twist[2]});
  motion.translation() << twist[3], twist[4], twist[5];
  return motion * pose;
}

TEST(RelativePose, IsHalfTheWayOfEveryPoint) {
  const Rigid3d measured(Eigen::Translation3d(0, 0, 0.1));
  const RelativePose edge(Rigid3d::Identity(), measured, SomePoints());
  EdgeResidual expected = EdgeResidual::Zero();
  expected.row(2).setConstant(-0.05);
  EXPECT_TRUE(EdgeValue(edge, kNoTwist, kNoTwist).isApprox(expected, 1e-12));
  EXPECT_NEAR(expected.norm(), 0.1, 1e-12);  // Root mean square of all.
  // A twist of j moves them there, one of i away.
  EXPECT_LT(EdgeValue(edge, kNoTwist, {0, 0, 0, 0, 0, 0.1}).norm(), 1e-12);
  EXPECT_NEAR(EdgeValue(edge, {0, 0, 0, 0, 0, 0.1}, kNoTwist).norm(), 0.2,
              1e-12);
}

TEST(RelativePose, IsZeroAtConsistentPosesWhateverTheWorld) {
  const Rigid3d i = MakeMotion({0.3, -1, 0.2}, {0.5, 0, -1});
  const Rigid3d j = MakeMotion({-0.1, 0.4, 1}, {0, 0.7, 0.2});
  const EdgeTwist from = {0.1, 0.2, -0.1, 0.3, 0, 0.1};
  const EdgeTwist to = {-0.2, 0.1, 0, 0, 0.2, -0.3};
  const Rigid3d measured = MovedPose(to, j) * MovedPose(from, i).inverse();
  for (const Rigid3d& world :
       {Rigid3d(Rigid3d::Identity()), MakeMotion({2, 0, 1}, {5, 6, 7})}) {
    const Rigid3d before = (j * world) * (i * world).inverse();
    const RelativePose edge(before, measured, SomePoints());
    EXPECT_LT(EdgeValue(edge, from, to).norm(), 1e-12);
    EXPECT_GT(EdgeValue(edge, kNoTwist, to).norm(), 0.1);
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
