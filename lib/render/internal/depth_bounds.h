#ifndef SPLITFUSION_LIB_RENDER_INTERNAL_DEPTH_BOUNDS_H_
#define SPLITFUSION_LIB_RENDER_INTERNAL_DEPTH_BOUNDS_H_

#include <utility>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/render/ray_caster.h"
#include "splitfusion/lib/tsdf/internal/leaf_table.h"

namespace splitfusion {
namespace internal {

/// Nearest and farthest depth of any block behind tiles of the image: where a
/// ray has to look. A tile without a block has near > far.
class DepthBounds {
 public:
  /// `places`: of all blocks, of voxels of `voxel_size` metres.
  DepthBounds(const std::vector<LeafPlace>& places, float voxel_size,
              const Rigid3f& camera_from_canonical, const PinholeCamera& camera,
              const RayCastOptions& options);

  /// Depth range of the ray through pixel (u, v); false if there is nothing.
  bool Range(int u, int v, float* near, float* far) const {
    const auto& bound =
        bounds_[static_cast<std::size_t>(v / kTile) * columns_ + u / kTile];
    *near = bound.first, *far = bound.second;
    return *near < *far;
  }

 private:
  static constexpr int kTile = 8;  // Pixels.

  void Add(const PinholeCamera& camera, const Eigen::Vector3f& center,
           float radius);

  int columns_, rows_;
  float near_, far_;
  std::vector<std::pair<float, float>> bounds_;
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_INTERNAL_DEPTH_BOUNDS_H_
