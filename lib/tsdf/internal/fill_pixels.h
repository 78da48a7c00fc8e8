#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_FILL_PIXELS_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_FILL_PIXELS_H_

#include <cstdint>

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// Records of a row of pixels, given depths (metres, 0 = none), confidences and
/// roles (PixelRole). Raises the `reach` of each to the z-depth up to which it
/// changes voxels, if it does; of `view` all but its images counts.
void FillPixels(const FusionView& view, const float* depth, const float* weight,
                const std::uint8_t* role, int count, FusionPixel* pixels,
                float* reach);

/// Packed colours of a row of pixels, given blue, green and red: the nearest
/// ones, or some beside them.
void FillColors(const std::uint8_t* bgr, int count, std::int32_t* colors);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_FILL_PIXELS_H_
