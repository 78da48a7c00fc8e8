#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_IMAGE_BOX_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_IMAGE_BOX_H_

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// Bounding box of points in depth and in the image.
struct ImageBox {
  bool in_front = false;  ///< All points are well in front of the camera.
  float z_low = 0;        ///< Metres.
  float u_low = 0, u_high = 0, v_low = 0, v_high = 0;  ///< Pixels.
};

/// Boxes around the voxels of blocks, of which only the bases are asked.
void BoundBlocks(const FusionView& view, const RigidBlock* blocks, int count,
                 const float steps[3][3], ImageBox* boxes);

/// Box around the points of a lattice (camera frame, metres).
ImageBox BoundLattice(const FusionView& view,
                      const float lattice[kLatticePoints][3]);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_IMAGE_BOX_H_
