#include "splitfusion/lib/tsdf/internal/fusion_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "splitfusion/lib/tsdf/internal/packed_color.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr FusionPixel kNoPixel = {-kInfinity, 0};
constexpr auto kWrites = static_cast<std::uint8_t>(PixelRole::kWrite);
constexpr auto kCarves = static_cast<std::uint8_t>(PixelRole::kCarve);

/// Multiples of the golden section are spread evenly over 0..1, those of one
/// voxel over time as well as those of neighbours.
float Dither(int time, int z) {
  constexpr double kGolden = 0.6180339887498949;
  const double phase = kGolden * (static_cast<double>(time) + 3 * z);
  return static_cast<float>(std::min(phase - std::floor(phase), 0.999));
}

/// The nearest packed colour, or one beside it.
std::int32_t PackBytes(const cv::Vec3b& bgr) {
  return PackColor(ChannelFromByte(bgr[2]), ChannelFromByte(bgr[1]),
                   ChannelFromByte(bgr[0]));
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
  reach_.assign(static_cast<std::size_t>(columns_) * rows_, 0);
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
  tbb::parallel_for(0, rows_, [&](int tile_row) {
    const int end = std::min(camera.height, (tile_row + 1) * kTile);
    for (int v = tile_row * kTile; v < end; ++v) FillRow(observation, v);
  });
}

void FusionImage::FillRow(const DepthObservation& observation, int v) {
  const float* depth = observation.depth[v];
  const float* weight = observation.weight[v];
  const std::uint8_t* role = observation.role[v];
  FusionPixel* pixels = &pixels_[static_cast<std::size_t>(v) * view_.width];
  float* reach = &reach_[static_cast<std::size_t>(v / kTile) * columns_];
  for (int u = 0; u < view_.width; ++u) {
    const bool writes = role[u] == kWrites;
    const bool counts = (writes || role[u] == kCarves) && depth[u] > 0;
    pixels[u] = {counts ? depth[u] : -kInfinity,
                 counts ? (writes ? weight[u] : -weight[u]) : 0};
    // Of a pixel that says nothing: - infinity.
    const float reaches =
        pixels[u].depth + (writes ? truncation_ : -truncation_);
    reach[u / kTile] = std::max(reach[u / kTile], reaches);
  }
  if (color_ == nullptr) return;
  const cv::Vec3b* bgr = observation.color.ptr<cv::Vec3b>(v);
  std::int32_t* color = &color_[static_cast<std::size_t>(v) * view_.width];
  for (int u = 0; u < view_.width; ++u) color[u] = PackBytes(bgr[u]);
}

FusedPart FusionImage::MayChange(const ImageBox& box) const {
  if (!box.in_front) return {kInfinity, false};
  constexpr float kPixelMargin = 1;      // Rounding to pixels, and of floats.
  constexpr float kDepthMargin = 1e-3f;  // Metres; rounding.
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
