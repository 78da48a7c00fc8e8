#include "splitfusion/lib/tracking/rigid_parts.h"

#include <gtest/gtest.h>

#include <random>

#include "splitfusion/lib/base/thread_limit.h"

namespace splitfusion {
namespace {

Rigid3d Turned(double angle, const Eigen::Vector3d& axis,
               const Eigen::Vector3d& about, const Eigen::Vector3d& way) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  motion.translation() = about - motion.linear() * about + way;
  return motion;
}

/// A forearm's and a shin's points and motions, and as many wrong matches.
struct TwoLimbs {
  TwoLimbs() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-0.5f, 0.5f);
    const auto add = [&](const Eigen::Vector3f& middle, const Rigid3d& motion,
                         int count) {
      for (int i = 0; i < count; ++i) {
        const Eigen::Vector3f from =
            middle + Eigen::Vector3f(0.08f * any(random), 0.25f * any(random),
                                     0.06f * any(random));
        motions.push_back({from, motion.cast<float>() * from});
        motions.back().to +=
            0.004f * Eigen::Vector3f(any(random), any(random), any(random));
      }
    };
    add({-0.3f, 0, 1.2f}, forearm, 60);
    add({0.3f, 0.6f, 1.4f}, shin, 40);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3f from(any(random), any(random),
                                 1.3f + 0.2f * any(random));
      motions.push_back(
          {from, from + 0.4f * Eigen::Vector3f(any(random), any(random),
                                               any(random))});
    }
  }

  const Rigid3d forearm =
      Turned(0.5, Eigen::Vector3d::UnitZ(), {-0.3, 0.1, 1.2}, {0.08, 0, 0});
  const Rigid3d shin =
      Turned(-0.3, Eigen::Vector3d::UnitX(), {0.3, 0.4, 1.4}, {0, 0, -0.1});
  std::vector<PointMotion> motions;
};

TEST(RigidParts, AreFoundAmongWrongMatches) {
  const TwoLimbs limbs;
  const std::vector<RigidPart> parts =
      FindRigidParts(limbs.motions, DepthNoise(), RigidPartOptions());
  ASSERT_EQ(parts.size(), 2u);
  const Eigen::Vector3d wrist(-0.3, -0.12, 1.2), ankle(0.3, 0.72, 1.4);
  EXPECT_LT((parts[0].motion * wrist - limbs.forearm * wrist).norm(), 0.003);
  EXPECT_LT((parts[1].motion * ankle - limbs.shin * ankle).norm(), 0.003);
  int of_forearm = 0;
  for (const int point : parts[0].points) of_forearm += point < 60;
  EXPECT_EQ(of_forearm, 60);
  EXPECT_LT(parts[0].points.size(), 66u);
}

TEST(RigidParts, AreNoMoreThanAskedForAndTheLargestFirst) {
  const TwoLimbs limbs;
  RigidPartOptions options;
  options.count = 1;
  const auto parts = FindRigidParts(limbs.motions, DepthNoise(), options);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_GE(parts[0].points.size(), 60u);
}

TEST(RigidParts, AreNoneOfTooFewPoints) {
  TwoLimbs limbs;
  limbs.motions.resize(11);
  EXPECT_TRUE(
      FindRigidParts(limbs.motions, DepthNoise(), RigidPartOptions()).empty());
}

TEST(RigidParts, AreTheSameInEveryRun) {
  const TwoLimbs limbs;
  const auto first =
      FindRigidParts(limbs.motions, DepthNoise(), RigidPartOptions());
  const ThreadLimit one(1);
  const auto second =
      FindRigidParts(limbs.motions, DepthNoise(), RigidPartOptions());
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].points, second[i].points);
    EXPECT_EQ(first[i].motion.matrix(), second[i].motion.matrix());
  }
}

}  // namespace
}  // namespace splitfusion
