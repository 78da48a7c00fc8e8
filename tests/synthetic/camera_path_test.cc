#include "splitfusion/lib/synthetic/camera_path.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace splitfusion {
namespace {

using Eigen::Vector3d;

TEST(CameraPath, ATripodDoesNotMove) {
  SyntheticOptions options;
  options.camera_motion = 0;
  const CameraPath path(options);
  EXPECT_TRUE(path.WorldFromCamera(0).isApprox(path.WorldFromCamera(3.7)));
}

TEST(CameraPath, PosesAreRigidAndUpright) {
  const CameraPath path{SyntheticOptions()};
  for (double time = 0; time < 10; time += 0.7) {
    const Rigid3d pose = path.WorldFromCamera(time);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-9);
    EXPECT_TRUE((pose.linear() * pose.linear().transpose()).isIdentity(1e-9));
    // The image's y axis points down, its z axis into the room.
    EXPECT_LT(pose.linear()(2, 1), -0.9);
    EXPECT_GT(pose.linear()(1, 2), 0.8);
  }
}

TEST(CameraPath, MovesLikeAHand) {
  const CameraPath path{SyntheticOptions()};
  double way = 0, fastest = 0, turned = 0;
  for (int i = 0; i < 300; ++i) {
    const Rigid3d step = path.WorldFromCamera(i / 30.0).inverse() *
                         path.WorldFromCamera((i + 1) / 30.0);
    way += step.translation().norm();
    fastest = std::max(fastest, step.translation().norm() * 30);
    turned += RotationAngle(step.linear());
  }
  EXPECT_GT(way / 10, 0.1);  // Metres a second.
  EXPECT_LT(fastest, 0.5);
  EXPECT_GT(turned / 10, 0.05);  // Radians a second.
  EXPECT_LT(turned / 10, 0.3);
}

TEST(CameraPath, MovesInAllSixDirections) {
  const CameraPath path{SyntheticOptions()};
  const Rigid3d start = path.WorldFromCamera(0);
  Vector3d shift = Vector3d::Zero(), turn = Vector3d::Zero();
  for (double time = 0; time < 5; time += 0.1) {
    const Rigid3d motion = start.inverse() * path.WorldFromCamera(time);
    const Eigen::AngleAxisd rotation(motion.linear());
    shift = shift.cwiseMax(motion.translation().cwiseAbs());
    turn = turn.cwiseMax((rotation.angle() * rotation.axis()).cwiseAbs());
  }
  EXPECT_GT(shift.minCoeff(), 0.04);  // Metres.
  EXPECT_GT(turn.minCoeff(), 0.03);   // Radians.
}

TEST(CameraPath, AmplitudeScalesTheSweep) {
  SyntheticOptions options;
  const auto sweep = [&](double amplitude) {
    options.camera_motion = amplitude;
    const CameraPath path(options);
    return (path.WorldFromCamera(1.5).translation() -
            path.WorldFromCamera(0).translation())
        .norm();
  };
  EXPECT_NEAR(sweep(0.5), 0.5 * sweep(1), 1e-9);
}

}  // namespace
}  // namespace splitfusion
