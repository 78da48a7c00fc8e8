#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_

#include <openvdb/openvdb.h>

#include <vector>

#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// The grids of a volume. All three have the same leaves.
struct TsdfVolume::Grids {
  openvdb::FloatGrid::Ptr distance;
  openvdb::FloatGrid::Ptr weight;
  openvdb::Vec3SGrid::Ptr color;

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

/// Folds one measured voxel into the running mean.
/// `sdf`: distance along the ray, not yet truncated, metres.
struct VoxelUpdater {
  const DepthObservation& observation;
  float truncation;
  float max_weight;
  float max_free_weight;

  /// Updates the voxel whose centre is at `p` in the camera frame.
  void Update(const Eigen::Vector3f& p, float* distance, float* weight,
              openvdb::Vec3s* color) const;
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_GRIDS_H_
