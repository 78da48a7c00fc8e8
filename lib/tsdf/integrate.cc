#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/tsdf/check_observation.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

/// Whether the block can be seen: its bounding sphere reaches into the image.
bool InView(const PinholeCamera& camera, const Eigen::Vector3f& center,
            float radius) {
  if (center.z() < -radius) return false;
  const float z = std::max(center.z(), radius);
  const float margin_x = static_cast<float>(camera.fx) * radius / z;
  const float margin_y = static_cast<float>(camera.fy) * radius / z;
  const float u = static_cast<float>(camera.fx) * center.x() / z +
                  static_cast<float>(camera.cx);
  const float v = static_cast<float>(camera.fy) * center.y() / z +
                  static_cast<float>(camera.cy);
  return u > -2 * margin_x && v > -2 * margin_y &&
         u < static_cast<float>(camera.width) + 2 * margin_x &&
         v < static_cast<float>(camera.height) + 2 * margin_y;
}

/// What the blocks of a volume have in common.
struct RigidMotion {
  RigidMotion(const Rigid3d& camera_from_canonical, double voxel_size)
      : camera_from_canonical(camera_from_canonical.cast<float>()),
        voxel(static_cast<float>(voxel_size)),
        axes(voxel * this->camera_from_canonical.linear()) {
    for (int from = 0; from < 3; ++from) {
      for (int to = 0; to < 3; ++to) steps[from][to] = axes(to, from);
    }
  }

  Rigid3f camera_from_canonical;
  float voxel;           // Metres.
  Eigen::Matrix3f axes;  // From one voxel to the next.
  float steps[3][3];     // The same as FuseRigidBlocks() has it.
};

/// Where a block is, and what of it may change; false: nothing.
bool FindBlock(const internal::FusionImage& image, const PinholeCamera& camera,
               const RigidMotion& motion, const internal::LeafBuffers& leaf,
               internal::RigidBlock* block) {
  const Eigen::Vector3f origin(static_cast<float>(leaf.origin.x()),
                               static_cast<float>(leaf.origin.y()),
                               static_cast<float>(leaf.origin.z()));
  Eigen::Map<Eigen::Vector3f> base(block->base);
  base = motion.camera_from_canonical * (motion.voxel * origin);
  const internal::ImageBox box =
      internal::BoundBlock(image.view(), block->base, motion.steps);
  if (!box.in_front) {
    constexpr float kHalf = 0.5f * (kLeafSize - 1);
    const Eigen::Vector3f center =
        base + motion.axes * Eigen::Vector3f::Constant(kHalf);
    if (!InView(camera, center, 1.8f * kHalf * motion.voxel)) return false;
  }
  block->part = image.MayChange(box);
  block->leaf = internal::ToFused(leaf);
  if (box.z_low >= block->part.farthest) return false;
  if (box.in_front) image.Prefetch(box);
  return true;
}

}  // namespace

void IntegrateRigid(const DepthObservation& observation,
                    const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  CheckObservation(observation, volume->options());
  TsdfVolume::Grids& grids = volume->grids();
  const RigidMotion motion(camera_from_canonical, volume->options().voxel_size);
  ++grids.time;
  const internal::FusionImage image(observation, volume->options(), grids.time);
  constexpr std::size_t kBatch = 16;  // Blocks.
  const std::size_t batches = (grids.leaves.size() + kBatch - 1) / kBatch;
  tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
    internal::RigidBlock blocks[kBatch];
    std::size_t numbers[kBatch];
    int count = 0;
    const std::size_t begin = batch * kBatch;
    const std::size_t end = std::min(begin + kBatch, grids.leaves.size());
    for (std::size_t i = begin; i < end; ++i) {
      numbers[count] = i;
      count += FindBlock(image, observation.camera, motion, grids.leaves[i],
                         &blocks[count]);
    }
    internal::FuseRigidBlocks(image.view(), motion.steps, blocks, count);
    for (int i = 0; i < count; ++i) {
      if (blocks[i].changed) grids.RecordChange(numbers[i]);
    }
  });
}

}  // namespace splitfusion
