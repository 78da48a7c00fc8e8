#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_

#include <openvdb/openvdb.h>

#include <vector>

#include "splitfusion/lib/tsdf/internal/leaf_table.h"
#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace internal {

constexpr int kLeafSize = 8;      // Voxels along a leaf's edge.
constexpr int kLeafVoxels = 512;  // Voxels of a leaf.

/// Raw buffers of one block; voxel (x, y, z) is at 64 x + 8 y + z.
struct LeafBuffers {
  openvdb::Coord origin;
  float* distance = nullptr;
  float* weight = nullptr;
  std::int32_t* color = nullptr;  // Packed; null: without colour.
};

/// What fusion made of a block.
struct LeafState {
  int changed = 0;          // Last integration that its mesh may show.
  bool has_inside = false;  // Some observed distance is not positive.
};

/// The same for the loops that are free of OpenVDB.
FusedLeaf ToFused(const LeafBuffers& leaf);

/// Place of the block that a voxel is in.
inline LeafPlace PlaceOf(const openvdb::Coord& voxel) {
  return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};
}

}  // namespace internal

/// The grids of a volume. All have the same leaves.
struct TsdfVolume::Grids {
  openvdb::FloatGrid::Ptr distance;
  openvdb::FloatGrid::Ptr weight;
  openvdb::Int32Grid::Ptr color;  // Packed; null: without colour.

  /// All blocks in the order in which they came to be, and their numbers + 1 by
  /// their place.
  std::vector<internal::LeafBuffers> leaves;
  std::vector<internal::LeafState> states;  // Of the leaves.
  internal::LeafTable table;
  /// Integrations so far.
  int time = 0;

  /// Makes sure that the block with this origin exists in all grids.
  void Touch(const openvdb::Coord& origin);

  /// Enters the blocks of grids that were filled by others; what has no weight
  /// becomes free space.
  void Enter();

  /// Notes that the present integration changed a block; `has_inside`: it now
  /// HasInside().
  void RecordChange(std::size_t leaf, bool has_inside) {
    states[leaf] = {time, has_inside};
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
