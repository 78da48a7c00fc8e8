#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_

#include <openvdb/openvdb.h>

#include <unordered_map>
#include <vector>

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// The grids of a volume. All three have the same leaves.
struct TsdfVolume::Grids {
  openvdb::FloatGrid::Ptr distance;
  openvdb::FloatGrid::Ptr weight;
  openvdb::Vec3SGrid::Ptr color;

  /// When a block, by its origin, last changed in a way that its mesh may show:
  /// the `time` of that integration.
  std::unordered_map<openvdb::Coord, int> changed;
  /// Integrations so far.
  int time = 0;

  /// Makes sure that the block with this origin exists in all grids.
  void Touch(const openvdb::Coord& origin);
};

namespace internal {

constexpr int kLeafSize = 8;      // Voxels along a leaf's edge.
constexpr int kLeafVoxels = 512;  // Voxels of a leaf.

/// Raw buffers of one block; voxel (x, y, z) is at 64 x + 8 y + z.
struct LeafBuffers {
  openvdb::Coord origin;
  float* distance = nullptr;
  float* weight = nullptr;
  openvdb::Vec3s* color = nullptr;
};

/// The same, to be read.
struct ConstLeafBuffers {
  openvdb::Coord origin;
  const float* distance = nullptr;
  const float* weight = nullptr;
  const openvdb::Vec3s* color = nullptr;
};

/// Buffers of all blocks, in the tree's order.
std::vector<LeafBuffers> CollectLeaves(TsdfVolume* volume);

/// Buffers of all blocks, in the tree's order.
std::vector<ConstLeafBuffers> CollectLeaves(const TsdfVolume& volume);

/// The same for the loops that are free of OpenVDB.
FusedLeaf ToFused(const LeafBuffers& leaf);

/// Notes which blocks an integration changed, see TsdfVolume::Grids::changed.
void RecordChanges(const std::vector<LeafBuffers>& leaves,
                   const std::vector<char>& changed, TsdfVolume* volume);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
