#include "splitfusion/lib/tsdf/sample_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

class SampleDistanceTest : public ::testing::Test {
 protected:
  SampleDistanceTest() {
    const DepthObservation wall =
        ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
    AllocateBand(wall, Rigid3d::Identity(), &volume_);
    IntegrateRigid(wall, Rigid3d::Identity(), &volume_);
  }

  TsdfVolume volume_{TsdfOptions{/*voxel_size=*/0.01, /*truncation=*/0.05}};
};

TEST_F(SampleDistanceTest, IsTheDistanceFromTheWall) {
  // Blocks end at multiples of 8 cm, also below 0.
  for (const double x : {-0.1612, -0.0801, -0.004, 0.0, 0.0777, 0.2}) {
    for (const double z : {0.962, 0.9999, 1.0, 1.031}) {
      const auto sample = SampleDistance(volume_, {x, -0.5 * x, z});
      ASSERT_TRUE(sample.has_value()) << x << " " << z;
      EXPECT_NEAR(sample->distance, 1 - z, 1e-4);
      EXPECT_NEAR((sample->gradient - Eigen::Vector3d(0, 0, -1)).norm(), 0,
                  0.01);
    }
  }
}

TEST_F(SampleDistanceTest, IsNotKnownWhereNothingWasObserved) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0, 0, 1.5), Eigen::Vector3d(5, 0, 1),
        Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 1e300),
        Eigen::Vector3d(nan, 0, 1)}) {
    EXPECT_FALSE(SampleDistance(volume_, point).has_value())
        << point.transpose();
  }
}

}  // namespace
}  // namespace splitfusion
