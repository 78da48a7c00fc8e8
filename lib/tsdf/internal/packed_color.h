#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_PACKED_COLOR_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_PACKED_COLOR_H_

#include <cstdint>

namespace splitfusion {
namespace internal {

/// Bits of a channel: a third of the memory of floats, and with dithering fine
/// enough for running means whose samples have eight.
constexpr int kChannelBits = 10;
/// The brightest value of a channel; the darkest is 0.
constexpr int kChannelEnd = (1 << kChannelBits) - 1;

/// Red, green and blue, 0..kChannelEnd, as voxels keep them; red in the lowest
/// bits.
constexpr std::int32_t PackColor(int red, int green, int blue) {
  return red | green << kChannelBits | blue << 2 * kChannelBits;
}

/// Channel 0 to 2 of a packed colour: 0..kChannelEnd.
constexpr int ChannelOf(std::int32_t color, int channel) {
  return color >> (kChannelBits * channel) & kChannelEnd;
}

/// The same as one of 256 values.
constexpr std::uint8_t ByteOf(std::int32_t color, int channel) {
  return static_cast<std::uint8_t>(
      (ChannelOf(color, channel) * 255 + kChannelEnd / 2) / kChannelEnd);
}

/// Channel of a colour of 256 values a channel: 0..kChannelEnd, the nearest one
/// or its neighbour; ByteOf() gives the byte back.
constexpr int ChannelFromByte(int byte) {
  static_assert(kChannelBits == 10);
  return byte << 2 | byte >> 6;
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_PACKED_COLOR_H_
