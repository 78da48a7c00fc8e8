#include "splitfusion/lib/render/internal/depth_bounds.h"

#include <algorithm>
#include <cmath>

namespace splitfusion {
namespace internal {

DepthBounds::DepthBounds(const std::vector<LeafPlace>& places, float voxel_size,
                         const Rigid3f& camera_from_canonical,
                         const PinholeCamera& camera,
                         const RayCastOptions& options)
    : columns_((camera.width + kTile - 1) / kTile),
      rows_((camera.height + kTile - 1) / kTile),
      near_(static_cast<float>(options.min_depth)),
      far_(static_cast<float>(options.max_depth)),
      bounds_(static_cast<std::size_t>(columns_) * rows_, {far_, near_}) {
  constexpr int kLeafSize = 8;
  // A ray that enters a block must be seen in front of it first.
  constexpr float kBefore = 2;  // Speed: voxels.
  const float radius = voxel_size * (0.87f * kLeafSize + kBefore);  // Maths.
  const float half = 0.5f * (kLeafSize - 1);
  for (const auto& [x, y, z] : places) {
    const Eigen::Vector3f corner(static_cast<float>(kLeafSize * x),
                                 static_cast<float>(kLeafSize * y),
                                 static_cast<float>(kLeafSize * z));
    Add(camera,
        camera_from_canonical *
            (voxel_size * (corner + Eigen::Vector3f::Constant(half))),
        radius);
  }
}

void DepthBounds::Add(const PinholeCamera& camera,
                      const Eigen::Vector3f& center, float radius) {
  if (center.z() + radius < near_ || center.z() - radius > far_) return;
  const float z = std::max(center.z() - radius, near_);
  const float reach_u = static_cast<float>(camera.fx) * radius / z;
  const float reach_v = static_cast<float>(camera.fy) * radius / z;
  // Where the sphere reaches behind the near plane its image is unbounded.
  const Eigen::Vector2f pixel = camera.Project<float>(
      {center.x(), center.y(), std::max(center.z(), near_)});
  const auto tile = [](float p, int count) {
    return std::clamp(static_cast<int>(std::floor(p / kTile)), 0, count - 1);
  };
  if (pixel.x() + reach_u < 0 || pixel.y() + reach_v < 0 ||
      pixel.x() - reach_u > static_cast<float>(camera.width) ||
      pixel.y() - reach_v > static_cast<float>(camera.height)) {
    return;
  }
  const int u_end = tile(pixel.x() + reach_u, columns_);
  const int v_end = tile(pixel.y() + reach_v, rows_);
  for (int v = tile(pixel.y() - reach_v, rows_); v <= v_end; ++v) {
    for (int u = tile(pixel.x() - reach_u, columns_); u <= u_end; ++u) {
      auto& bound = bounds_[static_cast<std::size_t>(v) * columns_ + u];
      bound.first = std::min(bound.first, z);
      bound.second =
          std::min(far_, std::max(bound.second, center.z() + radius));
    }
  }
}

}  // namespace internal
}  // namespace splitfusion
