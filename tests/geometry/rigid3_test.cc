#include "splitfusion/lib/geometry/rigid3.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(ExpSo3, IsTheRotationAboutTheAxis) {
  const Eigen::Vector3d omega(0.3, -0.2, 0.9);
  const Eigen::Matrix3d rotation = ExpSo3(omega);
  EXPECT_NEAR(RotationAngle(rotation), omega.norm(), 1e-12);
  EXPECT_TRUE((rotation * omega).isApprox(omega, 1e-12));
  EXPECT_TRUE((rotation * ExpSo3(-omega)).isIdentity(1e-12));
}

TEST(ExpSo3, IsSmoothAtZero) {
  EXPECT_TRUE(ExpSo3(Eigen::Vector3d::Zero()).isIdentity(0));
  const Eigen::Vector3d small(1e-13, 0, 0);
  EXPECT_NEAR(ExpSo3(small)(2, 1), 1e-13, 1e-20);
}

TEST(Orthonormalized, RepairsADriftedRotation) {
  const Eigen::Matrix3d rotation = ExpSo3({1, 2, 0.5});
  const Eigen::Matrix3d repaired =
      Orthonormalized(rotation + 1e-4 * Eigen::Matrix3d::Ones());
  EXPECT_TRUE((repaired * repaired.transpose()).isIdentity(1e-12));
  EXPECT_LT((repaired - rotation).norm(), 1e-3);
}

}  // namespace
}  // namespace splitfusion
