#include <gtest/gtest.h>

#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

/// Blocks of a wall at z-depth `depth`, metres, of which one pixel that counts
/// is `off` metres behind it.
std::size_t BlocksOfWall(double voxel, double depth, float off, int least) {
  TsdfOptions options;
  options.voxel_size = voxel;
  options.truncation = 4 * voxel;
  options.min_block_pixels = least;
  TsdfVolume volume(options);
  DepthObservation wall =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), depth));
  wall.depth(60, 80) += off;
  AllocateBand(wall, Rigid3d::Identity(), &volume);
  return volume.leaf_count();
}

TEST(AllocateBand, MakesNoBlocksForASinglePixel) {
  const std::size_t wall = BlocksOfWall(0.02, 1.5, 0, 2);
  EXPECT_GT(wall, 100u);
  EXPECT_EQ(BlocksOfWall(0.02, 1.5, 0.5, 2), wall);
  EXPECT_GT(BlocksOfWall(0.02, 1.5, 0.5, 1), BlocksOfWall(0.02, 1.5, 0, 1));
}

TEST(AllocateBand, MakesAllBlocksThatAreTooFarAwayForMorePixels) {
  // A block of 4 cm is 1.7 pixels wide at 3 m, less than one that counts.
  EXPECT_EQ(BlocksOfWall(0.005, 3, 0, 2), BlocksOfWall(0.005, 3, 0, 1));
  EXPECT_EQ(BlocksOfWall(0.005, 3, 0, 9), BlocksOfWall(0.005, 3, 0, 1));
}

}  // namespace
}  // namespace splitfusion
