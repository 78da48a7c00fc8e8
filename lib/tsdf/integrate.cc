#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "splitfusion/lib/tsdf/check_observation.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

/// What the blocks of a volume have in common.
struct RigidMotion {
  RigidMotion(const Rigid3d& camera_from_canonical, double voxel_size)
      : camera_from_canonical(camera_from_canonical.cast<float>()),
        voxel(static_cast<float>(voxel_size)) {
    const Eigen::Matrix3f axes = voxel * this->camera_from_canonical.linear();
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3f at(corner >> 2, corner >> 1 & 1, corner & 1);
      extent.extend((kLeafSize - 1) * axes * at);
    }
    for (int from = 0; from < 3; ++from) {
      for (int to = 0; to < 3; ++to) steps[from][to] = axes(to, from);
    }
  }

  Rigid3f camera_from_canonical;
  float voxel;                 // Metres.
  float steps[3][3];           // From one voxel to the next, by axes.
  Eigen::AlignedBox3f extent;  // Of a block, counted from its base.
};

constexpr std::size_t kBatch = 32;  // Speed: blocks.

/// Some blocks of a volume that may change.
struct FoundBlocks {
  internal::RigidLeaf blocks[kBatch];
  std::size_t leaves[kBatch];  // Their numbers in the volume.
  int count = 0;
};

/// Finds those of the leaves from `begin` to `end`, at most kBatch, that may
/// change.
FoundBlocks FindBlocks(const internal::FusionImage& image,
                       const RigidMotion& motion,
                       const std::vector<internal::LeafBuffers>& leaves,
                       std::size_t begin, std::size_t end) {
  FoundBlocks found;
  for (std::size_t i = begin; i < end; ++i) {
    const openvdb::Coord& origin = leaves[i].origin;
    const Eigen::Vector3f base =
        motion.camera_from_canonical *
        (motion.voxel *
         Eigen::Map<const Eigen::Vector3i>(origin.data()).cast<float>());
    const Eigen::AlignedBox3f box = motion.extent.translated(base);
    const float farthest = image.Farthest(box);
    if (box.min().z() >= farthest) continue;
    found.blocks[found.count] = {
        {base.x(), base.y(), base.z()}, farthest, internal::ToFused(leaves[i])};
    found.leaves[found.count++] = i;
  }
  return found;
}

}  // namespace

void IntegrateRigid(const DepthObservation& observation,
                    const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  CheckObservation(observation, volume->options());
  TsdfVolume::Grids& grids = volume->grids();
  const RigidMotion motion(camera_from_canonical, volume->options().voxel_size);
  ++grids.time;
  const internal::FusionImage image(observation, volume->options(), grids.time);
  const std::size_t batches = (grids.leaves.size() + kBatch - 1) / kBatch;
  tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
    const std::size_t begin = batch * kBatch;
    const FoundBlocks found =
        FindBlocks(image, motion, grids.leaves, begin,
                   std::min(begin + kBatch, grids.leaves.size()));
    for (int i = 0; i < found.count; ++i) {
      const internal::RigidLeaf& block = found.blocks[i];
      const internal::FusedLeaf& next =
          found.blocks[std::min(i + 1, found.count - 1)].leaf;
      if (internal::FuseRigidLeaf(image.view(), motion.steps, block, next)) {
        grids.RecordChange(found.leaves[i], internal::HasInside(block.leaf));
      }
    }
  });
}

}  // namespace splitfusion
