// Volumes that another program wrote.

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <limits>

#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

constexpr double kVoxel = 0.01;

/// Writes a block of 8x8x8 voxels as another program might.
class VolumeFile {
 public:
  explicit VolumeFile(float background = 0.04f)
      : distance_(openvdb::FloatGrid::create(background)),
        weight_(openvdb::FloatGrid::create(0)) {
    openvdb::initialize();
    distance_->setName("distance");
    weight_->setName("weight");
    distance_->insertMeta("truncation", openvdb::DoubleMetadata(0.04));
    distance_->insertMeta("max_weight", openvdb::DoubleMetadata(64));
    distance_->insertMeta("no_color", openvdb::BoolMetadata(true));
    Place(openvdb::math::Transform::createLinearTransform(kVoxel));
    distance_->tree().touchLeaf(openvdb::Coord(0));
  }

  void Place(const openvdb::math::Transform::Ptr& transform) {
    distance_->setTransform(transform);
    weight_->setTransform(transform);
  }

  void Set(const openvdb::Coord& voxel, float distance, float weight) {
    distance_->tree().setValue(voxel, distance);
    weight_->tree().setValue(voxel, weight);
  }

  std::string Write(const std::string& path) const {
    openvdb::io::File file(path);
    file.write({distance_, weight_});
    return path;
  }

 private:
  openvdb::FloatGrid::Ptr distance_, weight_;
};

TEST(ForeignVolume, WhatAnotherProgramDidNotObserveIsNoSurface) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const TemporaryFolder folder;
  VolumeFile foreign;
  // At corners of the block, so that cells of absent neighbours have it too.
  foreign.Set(openvdb::Coord(0), -0.02f, 0);
  foreign.Set(openvdb::Coord(7), -0.02f, -1);
  foreign.Set(openvdb::Coord(0, 7, 0), kNan, 5);
  foreign.Set(openvdb::Coord(7, 0, 0), -0.02f, kNan);
  const TsdfVolume empty =
      TsdfVolume::Read(foreign.Write(folder / "empty.vdb"));
  EXPECT_TRUE(ExtractMesh(empty, 0.5).empty());
  EXPECT_TRUE(ExtractMesh(empty, 0).empty());
  // A voxel of matter in observed space is a small closed surface; in the next
  // block, so that this one is meshed and those before it are not.
  for (int i = 0; i < 27; ++i) {
    const openvdb::Coord voxel(3 + i / 9, 3 + i / 3 % 3, 11 + i % 3);
    foreign.Set(voxel, i == 13 ? -0.01f : 0.01f, 1);
  }
  const TriangleMesh mesh =
      ExtractMesh(TsdfVolume::Read(foreign.Write(folder / "voxel.vdb")), 0.5);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(ForeignVolume, BlocksOfOneColorMayBePruned) {
  const TemporaryFolder folder;
  TsdfOptions options;
  options.voxel_size = kVoxel;
  TsdfVolume volume(options);
  volume.grids().Touch(openvdb::Coord(8, 0, 0));
  volume.Write(folder / "volume.vdb");
  openvdb::io::File file(folder / "volume.vdb");
  file.open();
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  file.close();
  const auto color = openvdb::gridPtrCast<openvdb::Vec3SGrid>(
      openvdb::findGridByName(*grids, "color"));
  color->tree().fill(openvdb::CoordBBox::createCube(openvdb::Coord(8, 0, 0), 8),
                     openvdb::Vec3s(1, 0, 0.5f));
  color->pruneGrid();
  EXPECT_EQ(color->tree().leafCount(), 0u);
  openvdb::io::File(folder / "pruned.vdb").write(*grids);
  const TsdfVolume pruned = TsdfVolume::Read(folder / "pruned.vdb");
  const std::int32_t packed =
      pruned.grids().color->tree().getValue(openvdb::Coord(9, 1, 1));
  EXPECT_EQ(internal::ByteOf(packed, 0), 255);
  EXPECT_EQ(internal::ByteOf(packed, 1), 0);
  EXPECT_NEAR(internal::ByteOf(packed, 2), 128, 1);
}

TEST(ForeignVolume, VolumesThatFusionCouldNotHaveMadeAreRefused) {
  const TemporaryFolder folder;
  ExpectInputError(
      [&] {
        TsdfVolume::Read(VolumeFile(-0.04f).Write(folder / "inside.vdb"));
      },
      "inside.vdb: grid 'distance' has background -0.04");
  const auto transform =
      openvdb::math::Transform::createLinearTransform(kVoxel);
  transform->postTranslate({5e5, 0, 0});
  VolumeFile moved;
  moved.Place(transform);
  ExpectInputError([&] { TsdfVolume::Read(moved.Write(folder / "moved.vdb")); },
                   "moved.vdb: grid 'distance' has a transform of its own");
}

}  // namespace
}  // namespace splitfusion
