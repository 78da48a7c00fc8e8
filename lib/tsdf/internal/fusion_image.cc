#include "splitfusion/lib/tsdf/internal/fusion_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "splitfusion/lib/geometry/camera.h"
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

/// Pixels along one axis; none if the last is before the first.
struct Range {
  int first, last;
};

/// Pixels that a box in front of the camera reaches along one axis.
Range PixelsOf(const Eigen::AlignedBox3f& box, int axis, float focal,
               float center, int size) {
  constexpr float kMargin = 1;  // Maths: pixels, of rounding to them.
  const float near = focal / box.min().z(), far = focal / box.max().z();
  const float low = box.min()[axis], high = box.max()[axis];
  const float begin = std::min(low * near, low * far) + center - kMargin;
  const float end = std::max(high * near, high * far) + center + kMargin;
  const auto last = static_cast<float>(size - 1);
  if (!(end >= 0 && begin <= last)) return {0, -1};
  return {static_cast<int>(std::max(begin, 0.0f)),
          static_cast<int>(std::min(end, last))};
}

}  // namespace

FusionImage::FusionImage(const DepthObservation& observation,
                         const TsdfOptions& options, int time)
    : columns_((observation.camera.width + kTile - 1) / kTile),
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
           static_cast<float>(options.truncation),
           observation.others_refute ? 1.0f : 0.0f,
           static_cast<float>(options.max_weight),
           static_cast<float>(options.reach_sigmas),
           camera.noise};
  for (int z = 0; z < 8; ++z) view_.dither[z] = Dither(time, z);
  tbb::parallel_for(0, rows_,
                    [&](int tile_row) { FillTiles(observation, tile_row); });
}

void FusionImage::FillTiles(const DepthObservation& observation, int tile_row) {
  const int width = view_.width;
  std::vector<float> reach(width, -kInfinity);  // Of columns.
  const int end = std::min(view_.height, (tile_row + 1) * kTile);
  for (int v = tile_row * kTile; v < end; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * width;
    FillPixels(view_, observation.depth[v], observation.weight[v],
               observation.role[v], width, &pixels_[row], reach.data());
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

float FusionImage::Farthest(const Eigen::AlignedBox3f& box) const {
  constexpr float kDepthMargin = 1e-3f;  // Maths: metres; rounding.
  if (!(box.max().z() > kNearPlane)) return -kInfinity;
  if (!(box.min().z() > kNearPlane)) return kInfinity;
  const Range u = PixelsOf(box, 0, view_.fx, view_.cx, view_.width);
  const Range v = PixelsOf(box, 1, view_.fy, view_.cy, view_.height);
  if (u.last < u.first || v.last < v.first) return -kInfinity;
  float farthest = -kInfinity;
  for (int row = v.first / kTile; row <= v.last / kTile; ++row) {
    for (int column = u.first / kTile; column <= u.last / kTile; ++column) {
      farthest = std::max(farthest, reach_[row * columns_ + column]);
    }
  }
  return farthest + kDepthMargin;
}

}  // namespace internal
}  // namespace splitfusion
