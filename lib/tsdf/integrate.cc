#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "splitfusion/lib/tsdf/check_observation.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/image_box.h"
#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

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

/// Whether the block can be seen: its bounding sphere reaches into the image.
bool InView(const PinholeCamera& camera, const RigidMotion& motion,
            const internal::RigidBlock& block) {
  constexpr float kHalf = 0.5f * (kLeafSize - 1);
  const Eigen::Vector3f center = Eigen::Map<const Eigen::Vector3f>(block.base) +
                                 motion.axes * Eigen::Vector3f::Constant(kHalf);
  const float radius = 1.8f * kHalf * motion.voxel;  // Maths.
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

constexpr std::size_t kBatch = 32;  // Speed: blocks.

/// Some blocks of a volume that may change.
struct FoundBlocks {
  internal::RigidBlock blocks[kBatch];
  std::size_t leaves[kBatch];  // Their numbers in the volume.
  int count = 0;
};

/// Finds those of the leaves from `begin` to `end`, at most kBatch, that may
/// change; `found`: none yet.
void FindBlocks(const internal::FusionImage& image, const PinholeCamera& camera,
                const RigidMotion& motion,
                const std::vector<internal::LeafBuffers>& leaves,
                std::size_t begin, std::size_t end, FoundBlocks* found) {
  const int asked = static_cast<int>(end - begin);
  for (int i = 0; i < asked; ++i) {
    const openvdb::Coord& origin = leaves[begin + i].origin;
    Eigen::Map<Eigen::Vector3f> base(found->blocks[i].base);
    base = motion.camera_from_canonical *
           (motion.voxel * Eigen::Vector3f(static_cast<float>(origin.x()),
                                           static_cast<float>(origin.y()),
                                           static_cast<float>(origin.z())));
  }
  internal::ImageBox boxes[kBatch];
  internal::BoundBlocks(image.view(), found->blocks, asked, motion.steps,
                        boxes);
  for (int i = 0; i < asked; ++i) {
    internal::RigidBlock& block = found->blocks[found->count];
    std::copy_n(found->blocks[i].base, 3, block.base);
    if (!boxes[i].in_front && !InView(camera, motion, block)) continue;
    block.part = image.MayChange(boxes[i]);
    if (boxes[i].z_low >= block.part.farthest) continue;
    if (boxes[i].in_front) image.Prefetch(boxes[i]);
    block.leaf = internal::ToFused(leaves[begin + i]);
    found->leaves[found->count++] = begin + i;
  }
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
    FoundBlocks found;
    const std::size_t begin = batch * kBatch;
    FindBlocks(image, observation.camera, motion, grids.leaves, begin,
               std::min(begin + kBatch, grids.leaves.size()), &found);
    internal::FuseRigidBlocks(image.view(), motion.steps, found.blocks,
                              found.count);
    for (int i = 0; i < found.count; ++i) {
      const internal::RigidBlock& block = found.blocks[i];
      if (!block.changed) continue;
      grids.RecordChange(found.leaves[i], block.has_inside);
    }
  });
}

}  // namespace splitfusion
