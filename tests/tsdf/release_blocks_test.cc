#include "splitfusion/lib/tsdf/release_blocks.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/tsdf/mesh_extractor.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

/// A wall at 1 m, and blocks half a metre before it, which are carved.
TsdfVolume WallAndFreeSpace() {
  const DepthObservation wall =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.0));
  TsdfVolume volume({0.01, 0.04, 64});
  AllocateAround({{0, 0, 0.5}, {0.1, 0, 0.5}}, 0.04, &volume);
  AllocateBand(wall, Rigid3d::Identity(), &volume);
  IntegrateRigid(wall, Rigid3d::Identity(), &volume);
  return volume;
}

TEST(ReleaseFreeBlocks, LeavesTheSurfaceAsItIs) {
  TsdfVolume volume = WallAndFreeSpace();
  const TriangleMesh before = ExtractMesh(volume, 0.1);
  const std::size_t blocks = volume.leaf_count();
  const std::size_t freed = ReleaseFreeBlocks(&volume);
  EXPECT_GT(freed, 7u);
  EXPECT_EQ(volume.leaf_count(), blocks - freed);
  const TriangleMesh after = MeshExtractor().Extract(volume, 0.1);
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_EQ(after.colors, before.colors);
  EXPECT_EQ(ReleaseFreeBlocks(&volume), 0u);
}

TEST(ReleaseFreeBlocks, FusionGoesOnAsBefore) {
  TsdfVolume volume = WallAndFreeSpace(), other = WallAndFreeSpace();
  ReleaseFreeBlocks(&volume);
  const DepthObservation nearer =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 0.99));
  for (TsdfVolume* one : {&volume, &other}) {
    AllocateBand(nearer, Rigid3d::Identity(), one);
    IntegrateRigid(nearer, Rigid3d::Identity(), one);
  }
  EXPECT_EQ(ExtractMesh(volume, 0.1).vertices,
            ExtractMesh(other, 0.1).vertices);
}

TEST(ReleaseFreeBlocks, BlocksBeginAnew) {
  TsdfVolume volume = WallAndFreeSpace();
  const std::size_t blocks = volume.leaf_count();
  ReleaseFreeBlocks(&volume);
  AllocateAround({{0, 0, 0.5}, {0.1, 0, 0.5}}, 0.04, &volume);
  EXPECT_EQ(volume.leaf_count(), blocks);
}

TEST(ReleaseFreeBlocks, AnEmptyVolumeIsFine) {
  TsdfVolume volume({0.01, 0.04, 64});
  EXPECT_EQ(ReleaseFreeBlocks(&volume), 0u);
}

}  // namespace
}  // namespace splitfusion
