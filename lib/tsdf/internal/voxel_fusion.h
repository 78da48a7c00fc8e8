#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_VOXEL_FUSION_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_VOXEL_FUSION_H_

#include <algorithm>
#include <cstdint>

#include "splitfusion/lib/geometry/depth_noise.h"

namespace splitfusion {
namespace internal {

/// What one pixel does to the voxels on its ray.
struct FusionPixel {
  float depth;   ///< Metres; - infinity: it changes nothing.
  float weight;  ///< Confidence; negative: it carves, and may refute.
};

/// An observation, for loops that are free of Eigen and OpenCV.
struct FusionView {
  const FusionPixel* pixels;  ///< Row by row; one more at the end changes none.
  /// The same of packed colours; not needed without colour.
  const std::int32_t* color;
  int width, height;
  float fx, fy, cx, cy;
  /// What is added before colours are cut to integers, by z; 0..1, and
  /// different in every integration.
  float dither[8];
  float truncation;  ///< Metres.
  float refutation;  ///< Of the weight of pixels that only carve, 0 or 1.
  float max_weight;
  float reach_sigmas;  ///< See ReachBehind().
  DepthNoise noise;
};

/// How far behind a measured depth voxels are written, metres: the truncation,
/// or as far as noise reaches, if that is more. Distances are clamped at the
/// truncation both ways. Were those that noise brings beyond it left out behind
/// the surface, but not before it, the mean would move the surface away: at
/// noise of half of the truncation by a twentieth of the noise.
inline float ReachBehind(const FusionView& view, float depth) {
  return std::max(view.truncation, view.reach_sigmas * view.noise.Sigma(depth));
}

/// Buffers of the block that is fused into; `color`: packed, of every voxel;
/// null: there is none.
struct FusedLeaf {
  float* distance;
  float* weight;
  std::int32_t* color;
};

/// No mesh asks whether a voxel has been observed more than this.
constexpr float kFirmWeight = 8;  // Speed.

/// A block that is carried rigidly, whose voxel (x, y, z) is at
///   base + x steps[0] + y steps[1] + z steps[2]
/// (camera frame, metres).
struct RigidLeaf {
  float base[3];
  float farthest;  ///< Nothing farther away may change: z-depth, metres.
  FusedLeaf leaf;
};

/// Fuses into a block; `next`: the one that comes after it, which the memory is
/// asked for. Returns whether a mesh may show it: a distance, a colour, or a
/// weight below kFirmWeight is another one.
bool FuseRigidLeaf(const FusionView& view, const float steps[3][3],
                   const RigidLeaf& rigid, const FusedLeaf& next);

/// Points of a block that are warped: every fourth voxel, 3 x 3 x 3.
constexpr int kLatticePoints = 27;
/// Cells between them: 2 x 2 x 2, of 4 x 4 x 4 voxels.
constexpr int kLatticeCells = 8;

/// Fuses into a block whose every fourth voxel is at `lattice` (camera frame,
/// metres; z varies fastest), and whose others are interpolated. Into cells
/// marked as `foreign` (z varies fastest) only free space is fused. Returns
/// the same as FuseRigidLeaf().
bool FuseWarpedLeaf(const FusionView& view,
                    const float lattice[kLatticePoints][3],
                    const bool foreign[kLatticeCells], const FusedLeaf& leaf);

/// Whether any distance of a block that has been observed is not positive.
bool HasInside(const FusedLeaf& leaf);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_VOXEL_FUSION_H_
