#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/tsdf/internal/fill_pixels.h"

#include <limits>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/pixel_role.h"

namespace splitfusion {
namespace internal {

SPLITFUSION_VECTOR_CLONES
void FillPixels(const FusionView& view, const float* __restrict depth,
                const float* __restrict weight,
                const std::uint8_t* __restrict role, int count,
                FusionPixel* __restrict pixels, float* __restrict reach) {
  constexpr auto kWrites = static_cast<std::uint8_t>(PixelRole::kWrite);
  constexpr auto kCarves = static_cast<std::uint8_t>(PixelRole::kCarve);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const FusionView local = view;  // Which no pixel's address can be that of.
  const bool refutes = view.refutation > 0;
  for (int u = 0; u < count; ++u) {
    const bool writes = role[u] == kWrites;
    const bool counts = (writes | (role[u] == kCarves)) & (depth[u] > 0);
    const float known = counts ? depth[u] : -kInfinity;
    const float confidence = counts ? weight[u] : 0;
    pixels[u].depth = known;
    pixels[u].weight = writes ? confidence : -confidence;
    const float behind = ReachBehind(local, depth[u]);
    const float reaches =
        known + ((writes | refutes) ? behind : -local.truncation);
    reach[u] = reach[u] < reaches ? reaches : reach[u];
  }
}

SPLITFUSION_VECTOR_CLONES
void FillColors(const std::uint8_t* __restrict bgr, int count,
                std::int32_t* __restrict colors) {
  for (int u = 0; u < count; ++u) {
    colors[u] =
        PackColor(ChannelFromByte(bgr[3 * u + 2]),
                  ChannelFromByte(bgr[3 * u + 1]), ChannelFromByte(bgr[3 * u]));
  }
}

}  // namespace internal
}  // namespace splitfusion
