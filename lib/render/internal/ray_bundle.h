#ifndef SPLITFUSION_LIB_RENDER_INTERNAL_RAY_BUNDLE_H_
#define SPLITFUSION_LIB_RENDER_INTERNAL_RAY_BUNDLE_H_

#include <vector>

#include "splitfusion/lib/tsdf/internal/leaf_table.h"

namespace splitfusion {
namespace internal {

/// What rays walk through; index space of the volume, distances in metres.
struct RayVolume {
  const LeafTable& table;
  std::vector<const float*> distance;  // By block number; [0] is of no block.
  std::vector<const float*> weight;
  std::vector<char> has_inside;  // Whether there may be surface.
  float origin[3];               // Of the rays.
  float voxel_size;              // Metres.
  float min_weight;              // Voxels observed less are not surface.
};

/// Rays that walk through a volume side by side, so that one does not wait for
/// the memory of another. A ray is at origin + t * step at z-depth t.
struct RayBundle {
  static constexpr int kRays = 32;

  float t[kRays];
  float t_end[kRays];  // A ray is at rest where t >= t_end.
  float step_x[kRays], step_y[kRays], step_z[kRays];
  float voxel_step[kRays];  // z-depth of one voxel along the ray.
  float previous[kRays];    // Distance at the sample before; < 0: none.
  /// z-depth of the sample behind the surface where a ray has just gone
  /// through it, else 0.
  float crossing[kRays];
  int stopped[kRays];  // Whether a ray has just crossed or come to its end.
};

/// Takes the next sample of every ray that is not at rest and moves it on: over
/// a block that is not there, to the end of one without a surface, by half the
/// distance in free space, by less than a voxel elsewhere. Returns whether any
/// ray stopped.
bool StepRays(const RayVolume& volume, RayBundle* rays);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_INTERNAL_RAY_BUNDLE_H_
