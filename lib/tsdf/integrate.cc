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

/// Fuses into one block under a rigid motion; see FuseRigidLeaf().
bool IntegrateLeaf(const internal::FusionImage& image,
                   const PinholeCamera& camera,
                   const Rigid3f& camera_from_canonical, float voxel,
                   const internal::LeafBuffers& leaf) {
  const Eigen::Vector3f base =
      camera_from_canonical *
      (voxel * Eigen::Vector3f(static_cast<float>(leaf.origin.x()),
                               static_cast<float>(leaf.origin.y()),
                               static_cast<float>(leaf.origin.z())));
  const Eigen::Matrix3f steps = voxel * camera_from_canonical.linear();
  const float step_rows[3][3] = {{steps(0, 0), steps(1, 0), steps(2, 0)},
                                 {steps(0, 1), steps(1, 1), steps(2, 1)},
                                 {steps(0, 2), steps(1, 2), steps(2, 2)}};
  const internal::ImageBox box =
      internal::BoundBlock(image.view(), base.data(), step_rows);
  if (!box.in_front) {
    const float half = 0.5f * (kLeafSize - 1);
    const Eigen::Vector3f center =
        base + steps * Eigen::Vector3f::Constant(half);
    if (!InView(camera, center, 1.8f * half * voxel)) return false;
  }
  const internal::FusedPart part = image.MayChange(box);
  if (box.z_low >= part.farthest) return false;
  return internal::FuseRigidLeaf(image.view(), base.data(), step_rows, part,
                                 internal::ToFused(leaf));
}

}  // namespace

void IntegrateRigid(const DepthObservation& observation,
                    const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  CheckObservation(observation, volume->options());
  TsdfVolume::Grids& grids = volume->grids();
  const internal::FusionImage image(observation, volume->options());
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const float voxel = static_cast<float>(volume->options().voxel_size);
  ++grids.time;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, grids.leaves.size(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        if (IntegrateLeaf(image, observation.camera, motion,
                                          voxel, grids.leaves[i])) {
                          grids.RecordChange(i);
                        }
                      }
                    });
}

}  // namespace splitfusion
