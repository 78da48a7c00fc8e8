#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace internal {
namespace {

/// A voxel that is clearly in front of what was measured is empty. That counts
/// more than where a noisy ray ended, whatever the range: a limb that moved on
/// is gone within a few frames.
constexpr float kFreeSpaceWeight = 3.0f;
/// "Clearly": farther than the truncation by as many sigma of the depth.
constexpr float kFreeSpaceSigmas = 3.0f;

}  // namespace

void VoxelUpdater::Update(const Eigen::Vector3f& p, float* distance,
                          float* weight, openvdb::Vec3s* color) const {
  const PinholeCamera& camera = observation.camera;
  if (!(p.z() > 0.05f)) return;
  const float inverse_z = 1 / p.z();
  const int u = static_cast<int>(
      std::lround(static_cast<float>(camera.fx) * p.x() * inverse_z +
                  static_cast<float>(camera.cx)));
  const int v = static_cast<int>(
      std::lround(static_cast<float>(camera.fy) * p.y() * inverse_z +
                  static_cast<float>(camera.cy)));
  if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) return;
  const auto role = static_cast<PixelRole>(observation.role(v, u));
  const float depth = observation.depth(v, u);
  if (role == PixelRole::kNone || !(depth > 0)) return;
  const float sdf = depth - p.z();
  const bool in_band = role == PixelRole::kWrite && sdf >= -truncation;
  if (!in_band && sdf <= truncation) return;
  const float sample = std::min(sdf, truncation);
  const bool free_space =
      sdf > truncation + kFreeSpaceSigmas * DepthSigma(depth);
  const float confidence =
      free_space ? kFreeSpaceWeight : observation.weight(v, u);
  const float sum = *weight + confidence;
  if (!(sum > 0)) return;
  const float blend = confidence / sum;
  *distance += blend * (sample - *distance);
  if (in_band && std::abs(sdf) < truncation) {
    const auto* bgr = observation.color.ptr<cv::Vec3b>(v) + u;
    const openvdb::Vec3s rgb((*bgr)[2] / 255.0f, (*bgr)[1] / 255.0f,
                             (*bgr)[0] / 255.0f);
    *color += blend * (rgb - *color);
  }
  const bool emptied = free_space && *distance > 0.9f * truncation;
  *weight = std::min(sum, emptied ? max_free_weight : max_weight);
}

}  // namespace internal

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

void IntegrateLeaf(const internal::VoxelUpdater& updater,
                   const Rigid3f& camera_from_canonical, float voxel,
                   const internal::LeafBuffers& leaf) {
  const Eigen::Vector3f base =
      camera_from_canonical *
      (voxel * Eigen::Vector3f(static_cast<float>(leaf.origin.x()),
                               static_cast<float>(leaf.origin.y()),
                               static_cast<float>(leaf.origin.z())));
  const float half = 0.5f * voxel * (kLeafSize - 1);
  const Eigen::Vector3f center =
      base + camera_from_canonical.linear() * Eigen::Vector3f::Constant(half);
  if (!InView(updater.observation.camera, center, 1.8f * half)) return;
  const Eigen::Matrix3f steps = voxel * camera_from_canonical.linear();
  int offset = 0;
  for (int x = 0; x < kLeafSize; ++x) {
    for (int y = 0; y < kLeafSize; ++y) {
      Eigen::Vector3f p = base + static_cast<float>(x) * steps.col(0) +
                          static_cast<float>(y) * steps.col(1);
      for (int z = 0; z < kLeafSize; ++z, ++offset, p += steps.col(2)) {
        updater.Update(p, leaf.distance + offset, leaf.weight + offset,
                       leaf.color + offset);
      }
    }
  }
}

}  // namespace

void IntegrateRigid(const DepthObservation& observation,
                    const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  const std::vector<internal::LeafBuffers> leaves =
      internal::CollectLeaves(volume);
  const internal::VoxelUpdater updater{
      observation, static_cast<float>(volume->options().truncation),
      static_cast<float>(volume->options().max_weight),
      static_cast<float>(volume->options().max_free_weight)};
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const float voxel = static_cast<float>(volume->options().voxel_size);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 16),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        IntegrateLeaf(updater, motion, voxel, leaves[i]);
                      }
                    });
}

}  // namespace splitfusion
