#include "splitfusion/lib/geometry/typical_points.h"

#include <gtest/gtest.h>

#include <random>

#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

TEST(TypicalPoints, MoveAsFarAsAllPoints) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 50; ++i) {
    const float x = normal(random);
    points.push_back({x, 0.3f * normal(random) - x, 2 + 0.1f * normal(random)});
  }
  const TypicalPoints typical = TypicalPointsOf(points);
  const Rigid3d motion = MakeMotion({0.1, -0.2, 0.3}, {0.05, 0, -0.1});
  double all = 0;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d point = p.cast<double>();
    all += (motion * point - point).squaredNorm() / 50;
  }
  EXPECT_NEAR((motion * typical - typical).squaredNorm() / 4, all, 1e-9);
}

TEST(TypicalPoints, OfOneAreThatOneAndOfNoneZero) {
  const TypicalPoints one = TypicalPointsOf({{1, 2, 3}});
  for (int k = 0; k < 4; ++k) {
    EXPECT_TRUE(one.col(k).isApprox(Eigen::Vector3d(1, 2, 3)));
  }
  EXPECT_EQ(TypicalPointsOf({}), TypicalPoints::Zero());
}

}  // namespace
}  // namespace splitfusion
