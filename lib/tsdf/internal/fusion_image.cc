#include "splitfusion/lib/tsdf/internal/fusion_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "splitfusion/lib/tsdf/internal/fill_pixels.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr FusionPixel kNoPixel = {-kInfinity, 0};

/// Multiples of the golden section are spread evenly over 0..1, those of one
/// voxel over time as well as those of neighbours.
float Dither(int time, int z) {
  constexpr double kGolden = 0.6180339887498949;  // Maths.
  const double phase = kGolden * (static_cast<double>(time) + 3 * z);
  return static_cast<float>(
      std::min(phase - std::floor(phase), 0.999));  // Maths.
}

}  // namespace

FusionImage::FusionImage(const DepthObservation& observation,
                         const TsdfOptions& options, int time)
    : truncation_(static_cast<float>(options.truncation)),
      columns_((observation.camera.width + kTile - 1) / kTile),
      rows_((observation.camera.height + kTile - 1) / kTile) {
  const PinholeCamera& camera = observation.camera;
  const std::size_t count =
      static_cast<std::size_t>(camera.width) * camera.height;
  pixels_.reset(new FusionPixel[count + 1]);
  pixels_[count] = kNoPixel;
  reach_.resize(static_cast<std::size_t>(columns_) * rows_);
  if (options.has_color) {
    color_.reset(new std::int32_t[count + 1]);
    color_[count] = 0;
  }
  view_ = {pixels_.get(),
           color_.get(),
           camera.width,
           camera.height,
           static_cast<float>(camera.fx),
           static_cast<float>(camera.fy),
           static_cast<float>(camera.cx),
           static_cast<float>(camera.cy),
           {},
           truncation_,
           static_cast<float>(options.max_weight),
           static_cast<float>(options.max_free_weight)};
  for (int i = 0; i < 16; ++i) view_.dither[i] = Dither(time, i % 8);
  tbb::parallel_for(0, rows_,
                    [&](int tile_row) { FillTiles(observation, tile_row); });
}

void FusionImage::FillTiles(const DepthObservation& observation, int tile_row) {
  const int width = view_.width;
  std::vector<float> reach(width, -kInfinity);  // Of columns.
  const int end = std::min(view_.height, (tile_row + 1) * kTile);
  for (int v = tile_row * kTile; v < end; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * width;
    FillPixels(observation.depth[v], observation.weight[v], observation.role[v],
               width, truncation_, &pixels_[row], reach.data());
    if (color_ == nullptr) continue;
    FillColors(observation.color.ptr(v), width, &color_[row]);
  }
  for (int column = 0; column < columns_; ++column) {
    const int begin = column * kTile;
    reach_[static_cast<std::size_t>(tile_row) * columns_ + column] =
        *std::max_element(&reach[begin],
                          reach.data() + std::min(begin + kTile, width));
  }
}

FusedPart FusionImage::MayChange(const ImageBox& box) const {
  if (!box.in_front) return {kInfinity, false};
  constexpr float kPixelMargin = 1;      // Maths: pixels, of rounding to them.
  constexpr float kDepthMargin = 1e-3f;  // Maths: metres; rounding.
  const float u_low = box.u_low - kPixelMargin;
  const float v_low = box.v_low - kPixelMargin;
  const float u_high = box.u_high + kPixelMargin;
  const float v_high = box.v_high + kPixelMargin;
  if (!(u_high >= 0 && v_high >= 0 && u_low < static_cast<float>(view_.width) &&
        v_low < static_cast<float>(view_.height))) {
    return {-kInfinity, false};
  }
  const auto tile = [](float pixel, int count) {
    const float clamped =
        std::clamp(pixel, 0.0f, static_cast<float>(count * kTile - 1));
    return static_cast<int>(clamped) / kTile;
  };
  const int u_end = tile(u_high, columns_);
  const int v_end = tile(v_high, rows_);
  float farthest = -kInfinity;
  for (int v = tile(v_low, rows_); v <= v_end; ++v) {
    for (int u = tile(u_low, columns_); u <= u_end; ++u) {
      farthest = std::max(farthest, reach_[v * columns_ + u]);
    }
  }
  const bool in_image = u_low >= 0 && v_low >= 0 &&
                        u_high <= static_cast<float>(view_.width - 1) &&
                        v_high <= static_cast<float>(view_.height - 1);
  return {farthest + kDepthMargin, in_image};
}

void FusionImage::Prefetch(const ImageBox& box) const {
  constexpr int kLine = 64 / sizeof(FusionPixel);
  const auto inside = [](float pixel, int end) {
    return static_cast<int>(
        std::clamp(pixel, 0.0f, static_cast<float>(end - 1)));
  };
  const int u_low = inside(box.u_low, view_.width);
  const int u_high = inside(box.u_high, view_.width);
  const int v_high = inside(box.v_high, view_.height);
  for (int v = inside(box.v_low, view_.height); v <= v_high; ++v) {
    const FusionPixel* row =
        &pixels_[static_cast<std::size_t>(v) * view_.width];
    for (int u = u_low; u < u_high + kLine; u += kLine) {
      __builtin_prefetch(row + u);
    }
  }
}

}  // namespace internal
}  // namespace splitfusion
