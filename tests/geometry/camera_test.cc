#include "splitfusion/lib/geometry/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr PinholeCamera kCamera = {640, 480, 520, 530, 319.5, 240.25};

TEST(PinholeCamera, ProjectUndoesBackProject) {
  for (const double u : {0.0, 319.5, 639.0}) {
    for (const double v : {0.0, 100.25}) {
      const Eigen::Vector3d point = kCamera.BackProject(u, v, 2.5);
      EXPECT_EQ(point.z(), 2.5);
      EXPECT_LT((kCamera.Project(point) - Eigen::Vector2d(u, v)).norm(), 1e-9);
    }
  }
}

TEST(PinholeCamera, XIsRightAndYIsDown) {
  EXPECT_GT(kCamera.Project(Eigen::Vector3d(0.1, 0, 1)).x(), kCamera.cx);
  EXPECT_GT(kCamera.Project(Eigen::Vector3d(0, 0.1, 1)).y(), kCamera.cy);
}

TEST(PinholeCamera, FindsThePixelThatShowsAPoint) {
  const auto pixel = [](float u, float v, float depth) {
    return kCamera.PixelOf(kCamera.BackProject(u, v, depth));
  };
  EXPECT_EQ(pixel(0.4f, 100.6f, 2), Eigen::Vector2i(0, 101));
  EXPECT_EQ(pixel(-0.4f, 479.4f, 2), Eigen::Vector2i(0, 479));
  EXPECT_EQ(kCamera.PixelAt({0.5f, 238.5f}), Eigen::Vector2i(1, 239));
  for (const auto& beyond : {Eigen::Vector2f(-0.5f, 5),
                             {5, -0.5f},
                             {639.5f, 5},
                             {5, 479.5f},
                             {1e30f, 5}}) {
    EXPECT_FALSE(kCamera.PixelAt(beyond)) << beyond.transpose();
  }
  EXPECT_FALSE(pixel(5, 5, 0.5f * kNearPlane));
  EXPECT_FALSE(kCamera.PixelOf({0, 0, -1}));
  EXPECT_FALSE(kCamera.PixelOf({0, 0, NAN}));
  EXPECT_FALSE(kCamera.PixelAt({NAN, 5}));
}

TEST(PinholeCamera, SubsampledSeesTheSamePointsAtEveryKthPixel) {
  const PinholeCamera half = kCamera.Subsampled(4);
  EXPECT_EQ(half.width, 160);
  EXPECT_EQ(half.height, 120);
  const Eigen::Vector3d point = kCamera.BackProject(40.0, 84.0, 1.5);
  EXPECT_TRUE(half.Project(point).isApprox(Eigen::Vector2d(10, 21)));
  EXPECT_EQ(kCamera.Subsampled(7).width, 92);  // Pixels 0, 7, ... 637.
}

TEST(PinholeCamera, CheckNamesTheField) {
  PinholeCamera camera = kCamera;
  EXPECT_NO_THROW(camera.Check());
  camera.fy = std::nan("");
  try {
    camera.Check();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("camera fy = nan"));
  }
  camera = kCamera;
  camera.width = 0;
  EXPECT_THROW(camera.Check(), InputError);
}

TEST(PinholeCamera, CheckRefusesViewsThatNoPinholeHas) {
  PinholeCamera crop = {1, 1, 520, 530, 319.5, 240.25};
  EXPECT_NO_THROW(crop.Check());
  PinholeCamera wide = kCamera;
  wide.fx = 100;
  EXPECT_NO_THROW(wide.Check());
  for (const double fx : {60.0, 1.0}) {
    wide.fx = fx;
    try {
      wide.Check();
      FAIL() << fx;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  testing::StartsWith("camera cx = 319.5, size = 640, fx = "));
    }
  }
  PinholeCamera slip = kCamera;
  slip.cy = -1e9;
  EXPECT_THROW(slip.Check(), InputError);
}

}  // namespace
}  // namespace splitfusion
