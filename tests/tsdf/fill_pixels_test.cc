#include "splitfusion/lib/tsdf/internal/fill_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/pixel_role.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();
constexpr float kTruncation = 0.02f;

/// With noise of 10 mm at every depth.
FusionView ViewOf(float refutation) {
  FusionView view = {};
  view.truncation = kTruncation;
  view.refutation = refutation;
  view.reach_sigmas = 3;
  view.noise.least = 0.01;
  view.noise.growth = 0;
  return view;
}

/// A row of pixels of all depths and roles; some are no depths and no roles.
struct Row {
  explicit Row(int count) {
    const float depths[] = {
        1.5f, 0, -1, std::numeric_limits<float>::quiet_NaN(), 2, 0.7f, 3};
    for (int u = 0; u < count; ++u) {
      depth.push_back(depths[u % 7]);
      weight.push_back(0.25f * static_cast<float>(u % 5));
      role.push_back(static_cast<std::uint8_t>(u % 4));
    }
  }
  std::vector<float> depth, weight;
  std::vector<std::uint8_t> role;
};

/// Expects what is said of a row of `count` pixels; `carving`: how far behind
/// their depth those reach that carve.
void ExpectPixels(int count, const FusionView& view, float carving) {
  const Row row(count);
  std::vector<FusionPixel> pixels(count);
  std::vector<float> reach(count, 1);
  FillPixels(view, row.depth.data(), row.weight.data(), row.role.data(), count,
             pixels.data(), reach.data());
  for (int u = 0; u < count; ++u) {
    const auto role = static_cast<PixelRole>(row.role[u]);
    const bool writes = role == PixelRole::kWrite;
    if (!(row.depth[u] > 0) || !(writes || role == PixelRole::kCarve)) {
      EXPECT_EQ(pixels[u].depth, -kUnbounded) << u << " of " << count;
      EXPECT_EQ(pixels[u].weight, 0);
      EXPECT_EQ(reach[u], 1);
      continue;
    }
    EXPECT_EQ(pixels[u].depth, row.depth[u]) << u << " of " << count;
    EXPECT_EQ(std::abs(pixels[u].weight), row.weight[u]);
    EXPECT_EQ(std::signbit(pixels[u].weight), !writes);
    const float end = row.depth[u] + (writes ? 0.03f : carving);
    EXPECT_NEAR(reach[u], std::max(end, 1.0f), 1e-6);
  }
}

TEST(FillPixels, SaysWhatPixelsDo) {
  // Vectors, and what is left of them.
  for (const int count : {1, 7, 8, 13, 16, 117}) {
    ExpectPixels(count, ViewOf(0), -kTruncation);
    ExpectPixels(count, ViewOf(1), 0.03f);
  }
}

TEST(FillColors, PacksEveryByte) {
  constexpr int kCount = 259;
  std::vector<std::uint8_t> bgr;
  for (int i = 0; i < 3 * kCount; ++i) {
    bgr.push_back(static_cast<std::uint8_t>(i * 7));
  }
  std::vector<std::int32_t> colors(kCount);
  FillColors(bgr.data(), kCount, colors.data());
  for (int u = 0; u < kCount; ++u) {
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(ByteOf(colors[u], channel), bgr[3 * u + 2 - channel]) << u;
    }
  }
}

}  // namespace
}  // namespace internal
}  // namespace splitfusion
