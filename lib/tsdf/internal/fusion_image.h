#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_FUSION_IMAGE_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_FUSION_IMAGE_H_

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace internal {

/// An observation as voxels ask for it: one small record a pixel, and for tiles
/// of the image how far from the camera it can change anything.
class FusionImage {
 public:
  /// Keeps hold of nothing of the observation; `time`: the integration's.
  FusionImage(const DepthObservation& observation, const TsdfOptions& options,
              int time);
  /// The view points into it.
  FusionImage(const FusionImage&) = delete;
  /// The view points into it.
  FusionImage& operator=(const FusionImage&) = delete;

  /// For FuseRigidLeaf() and FuseWarpedLeaf().
  const FusionView& view() const { return view_; }

  /// Z-depth (metres) from which on no voxel within a box of the camera frame
  /// can be changed: rather too much than not enough.
  float Farthest(const Eigen::AlignedBox3f& box) const;

 private:
  static constexpr int kTile = 8;  // Pixels.

  void FillTiles(const DepthObservation& observation, int tile_row);

  int columns_, rows_;  // Of tiles.
  // Filled in parallel, not before.
  std::unique_ptr<FusionPixel[]> pixels_;
  std::vector<float> reach_;  // Per tile: farthest z-depth of any change.
  std::unique_ptr<std::int32_t[]> color_;  // Null: without colour.
  FusionView view_;
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_FUSION_IMAGE_H_
