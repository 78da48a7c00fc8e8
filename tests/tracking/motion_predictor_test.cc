#include "splitfusion/lib/tracking/motion_predictor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splitfusion {
namespace {

Rigid3d At(double x, double degrees = 0) {
  Rigid3d pose = Rigid3d::Identity();
  pose.linear() =
      Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitY())
          .toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, 0, 2);
  return pose;
}

TEST(MotionPredictor, KeepsTheVelocityOfTheLastFrame) {
  MotionPredictor predictor;
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kTracked);
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
  predictor.Record(At(0.1, 5), Eigen::Vector3d::Zero(), TrackState::kTracked);
  EXPECT_TRUE((predictor.velocity() * At(0)).isApprox(At(0.1, 5), 1e-12));
  predictor.Record(At(0.1, 5), Eigen::Vector3d::Zero(), TrackState::kLost);
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
}

TEST(MotionPredictor, CarriesHiddenSurfacesOnByTheUsualStepOfTheirCenter) {
  MotionPredictor predictor;
  const Eigen::Vector3d center(0.3, 0, 0);
  double x = 0;
  for (int i = 0; i < 9; ++i) {
    predictor.Record(At(x += 0.02), center, TrackState::kTracked);
  }
  // The last step before it vanishes is wrong, and so is its turn.
  predictor.Record(At(x += 0.5, 40), center, TrackState::kTracked);
  // It comes to rest while nothing is seen of it.
  double way = 0;
  for (int i = 0; i < 200; ++i) {
    predictor.Record(At(x, 40), center, TrackState::kOccluded);
    EXPECT_TRUE(predictor.velocity().linear().isIdentity(1e-12));
    EXPECT_TRUE(predictor.velocity().translation().isApprox(
        Eigen::Vector3d(0.02 * std::exp(-i / 15.0), 0, 0), 1e-9));
    way += predictor.velocity().translation().x();
  }
  EXPECT_NEAR(way, 0.02 * 15, 0.02);
}

TEST(MotionPredictor, TheJumpOfASurfaceThatIsBackIsNoVelocity) {
  MotionPredictor predictor;
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kTracked);
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kOccluded);
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
  predictor.Record(At(0.4), Eigen::Vector3d::Zero(), TrackState::kTracked);
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
  predictor.Record(At(0.41), Eigen::Vector3d::Zero(), TrackState::kTracked);
  EXPECT_NEAR(predictor.velocity().translation().x(), 0.01, 1e-12);
  // Neither is it a usual step.
  predictor.Record(At(0.41), Eigen::Vector3d::Zero(), TrackState::kOccluded);
  EXPECT_NEAR(predictor.velocity().translation().x(), 0.01, 1e-12);
}

TEST(MotionPredictor, AfterLostFramesTheVelocityIsThatOfOneFrame) {
  MotionPredictor predictor;
  const Eigen::Vector3d center(0.3, 0, 0);
  predictor.Record(At(0), center, TrackState::kLost);  // Born.
  predictor.Record(At(0.1), center, TrackState::kTracked);
  EXPECT_NEAR(predictor.velocity().translation().x(), 0.1, 1e-12);
  for (int i = 0; i < 3; ++i) {
    predictor.Record(At(0.1), center, TrackState::kLost);
    EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
  }
  // Four frames later it is 8 cm farther, and has turned by 20 degrees.
  const Rigid3d found = At(0.18, 20);
  predictor.Record(found, center, TrackState::kTracked);
  Rigid3d way = Rigid3d::Identity();
  for (int i = 0; i < 4; ++i) way = predictor.velocity() * way;
  EXPECT_TRUE(way.linear().isApprox((found * At(0.1).inverse()).linear()));
  const Eigen::Vector3d step =
      predictor.velocity() * (At(0.1) * center) - At(0.1) * center;
  EXPECT_TRUE(step.isApprox((found * center - At(0.1) * center) / 4, 1e-12));
  // It is no usual step.
  predictor.Record(found, center, TrackState::kOccluded);
  EXPECT_NEAR(predictor.velocity().translation().x(), 0.1, 1e-12);
}

TEST(MotionPredictor, LostFramesAfterHiddenOnesDoNotMakeAVelocityOfTheJump) {
  MotionPredictor predictor;
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kTracked);
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kOccluded);
  predictor.Record(At(0), Eigen::Vector3d::Zero(), TrackState::kLost);
  predictor.Record(At(0.6), Eigen::Vector3d::Zero(), TrackState::kTracked);
  EXPECT_TRUE(predictor.velocity().isApprox(Rigid3d::Identity()));
}

}  // namespace
}  // namespace splitfusion
