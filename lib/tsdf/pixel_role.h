#ifndef SPLITFUSION_LIB_TSDF_PIXEL_ROLE_H_
#define SPLITFUSION_LIB_TSDF_PIXEL_ROLE_H_

#include <cstdint>

namespace splitfusion {

/// What a depth pixel may do to the volume of one surface.
enum class PixelRole : std::uint8_t {
  kNone = 0,   ///< Says nothing about this surface.
  kCarve = 1,  ///< Of another surface: space in front of it is free; see also
               ///< DepthObservation::others_refute.
  kWrite = 2,  ///< Of this surface: its distance is written, and it carves.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_PIXEL_ROLE_H_
