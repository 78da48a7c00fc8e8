#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_ROW_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_ROW_H_

#include <cstdint>
#include <cstring>

#include "splitfusion/lib/geometry/depth_noise.h"
#include "splitfusion/lib/tsdf/internal/lanes.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// What is nearer to the camera is not seen, metres.
constexpr float kNear = 0.05f;

/// A voxel that is clearly in front of what was measured is empty. That counts
/// more than where a noisy ray ended, whatever the range: a limb that moved on
/// is gone within a few frames.
constexpr float kFreeSpaceWeight = 3.0f;

/// ... which it is for sure where it is nearer than the measured depth by the
/// truncation and as many sigma of the depth.
constexpr float kFreeSpaceSigmas = 3.0f;

/// Voxels side by side as the camera sees them: z-depth in metres, and pixel
/// coordinates times z.
template <typename Pack>
struct SeenVoxels {
  typename Pack::Real zu, zv, z;
};

/// Pixels that voxels fall on; outside of the image the one that changes
/// nothing. With `kAllInside` none is outside.
template <typename Pack, bool kAllInside>
SPLITFUSION_INLINE typename Pack::Whole PixelsOf(const FusionView& view,
                                                 const SeenVoxels<Pack>& at) {
  using Real = typename Pack::Real;
  using Whole = typename Pack::Whole;
  using Wrapping = typename Pack::Wrapping;  // Outside of the image.
  // Added to a number, it leaves the nearest integer in the lowest bits.
  constexpr float kRounding = 12582912.0f;  // 1.5 * 2^23
  const Real inverse_z = 1 / at.z;
  const auto zero = (Wrapping)Pack::Bits(Real{} + kRounding);
  const auto u_bits = (Wrapping)Pack::Bits(at.zu * inverse_z + kRounding);
  const auto v_bits = (Wrapping)Pack::Bits(at.zv * inverse_z + kRounding);
  const auto width = static_cast<std::uint32_t>(view.width);
  // v * width + u
  const auto pixel = (Whole)(v_bits * width + (u_bits - zero * (width + 1)));
  if (kAllInside) return pixel;
  const Wrapping u = u_bits - zero;
  const Wrapping v = v_bits - zero;
  const typename Pack::Mask inside =
      Pack::Less(Real{} + kNear, at.z) &
      Pack::Within((Whole)u, Whole{} + view.width) &
      Pack::Within((Whole)v, Whole{} + view.height);
  return Pack::Select(inside, pixel, Whole{} + view.width * view.height);
}

/// Running means of colours, by channels. They are rounded up as often as they
/// are close to the upper value: else a small difference would never move them.
/// `changed`: see FuseRow().
template <typename Pack, bool kAsksChanges>
SPLITFUSION_INLINE void BlendColors(const FusionView& view,
                                    const std::int32_t pixel[Pack::kCount],
                                    const typename Pack::Real& blend,
                                    const typename Pack::Mask& colored,
                                    std::int32_t* color,
                                    typename Pack::Whole* changed) {
  using Real = typename Pack::Real;
  using Whole = typename Pack::Whole;
  const Whole seen = Pack::Gather(view.color, pixel);
  Real dither;
  std::memcpy(&dither, view.dither, sizeof(dither));
  Whole before, after = {};
  std::memcpy(&before, color, sizeof(before));
  for (int shift = 0; shift < 3 * kChannelBits; shift += kChannelBits) {
    const Real mean =
        __builtin_convertvector(before >> shift & kChannelEnd, Real);
    const Real sample =
        __builtin_convertvector(seen >> shift & kChannelEnd, Real);
    const Real next = mean + blend * (sample - mean) + dither;
    after |= __builtin_convertvector(next, Whole) << shift;
  }
  after = Pack::Select(colored, after, before);
  std::memcpy(color, &after, sizeof(after));
  if (kAsksChanges) *changed |= after ^ before;
}

/// What the camera says about voxels that are side by side.
template <typename Pack>
struct SeenRow {
  typename Pack::Real depth, weight;  ///< Of the pixels, as FusionPixel.
  typename Pack::Mask changes;        ///< Says something.
};

/// Looks voxels up, given their pixels, their depths and, with `kForeign`,
/// which of them are foreign: those have a minus.
template <typename Pack, bool kForeign>
SPLITFUSION_INLINE void SeeRow(const FusionView& view,
                               const std::int32_t pixel[Pack::kCount],
                               const typename Pack::Real& z,
                               const typename Pack::Whole& foreign,
                               SeenRow<Pack>* row) {
  Pack::GatherPairs(reinterpret_cast<const float(*)[2]>(view.pixels), pixel,
                    &row->depth, &row->weight);
  if (kForeign) {
    row->weight = Pack::FromBits(Pack::Bits(row->weight) | foreign);
  }
  const typename Pack::Real sdf = row->depth - z;
  // In front of the truncation, or behind it if the pixel writes.
  const typename Pack::Whole writes = ~Pack::Bits(row->weight) & INT32_MIN;
  const typename Pack::Real reach = Pack::FromBits(
      Pack::Bits(typename Pack::Real{} + view.truncation) | writes);
  row->changes = Pack::Less(reach, sdf);
}

/// Where space is free for sure: the truncation and kFreeSpaceSigmas of
/// splitfusion::DepthSigma(), its square multiplied out.
template <typename Pack>
SPLITFUSION_INLINE typename Pack::Real FreeFrom(
    const FusionView& view, const typename Pack::Real& depth) {
  constexpr double kSquare = kFreeSpaceSigmas * kDepthSigmaGrowth;
  constexpr double kConstant =
      kFreeSpaceSigmas * kLeastDepthSigma + kSquare * kBestDepth * kBestDepth;
  constexpr double kLinear = -2 * kSquare * kBestDepth;
  return (static_cast<float>(kSquare) * depth + static_cast<float>(kLinear)) *
             depth +
         (view.truncation + static_cast<float>(kConstant));
}

/// Fuses what is seen into voxels that are side by side in memory, from `leaf`
/// on. With `kAsksChanges`, leaves bits in `changed` where a mesh may show it.
template <typename Pack, bool kAsksChanges>
SPLITFUSION_INLINE void FuseRow(const FusionView& view,
                                const std::int32_t pixel[Pack::kCount],
                                const typename Pack::Real& z,
                                const SeenRow<Pack>& row, const FusedLeaf& leaf,
                                typename Pack::Whole* changed) {
  using Real = typename Pack::Real;
  using Mask = typename Pack::Mask;
  const Real truncation = Real{} + view.truncation;
  const Real sdf = row.depth - z;  // Metres; positive in front.
  Real old_distance, old_weight;
  std::memcpy(&old_distance, leaf.distance, sizeof(Real));
  std::memcpy(&old_weight, leaf.weight, sizeof(Real));
  const Mask free_space = Pack::Less(FreeFrom<Pack>(view, row.depth), sdf);
  const Real seen_weight = Pack::FromBits(Pack::Bits(row.weight) & INT32_MAX);
  const Real confidence =
      Pack::Select(free_space, Real{} + kFreeSpaceWeight, seen_weight);
  const Real sum = old_weight + confidence;
  // No division by zero where neither voxel nor pixel has a weight.
  const Real blend = confidence / Pack::Max(sum, Real{} + 1e-30f);
  Real distance =
      old_distance + blend * (Pack::Min(truncation, sdf) - old_distance);
  const Mask emptied = free_space & Pack::Less(0.9f * truncation, distance);
  const Real cap = Pack::Select(emptied, Real{} + view.max_free_weight,
                                Real{} + view.max_weight);
  distance = Pack::Select(row.changes, distance, old_distance);
  const Real weight =
      Pack::Select(row.changes, Pack::Min(cap, sum), old_weight);
  if (kAsksChanges) {
    const Mask soft =
        Pack::Less(Pack::Min(weight, old_weight), Real{} + kFirmWeight);
    *changed |= Pack::Bits(distance) ^ Pack::Bits(old_distance);
    *changed |= Pack::Select(soft, Pack::Bits(weight) ^ Pack::Bits(old_weight),
                             typename Pack::Whole{});
  }
  std::memcpy(leaf.distance, &distance, sizeof(Real));
  std::memcpy(leaf.weight, &weight, sizeof(Real));
  if (leaf.color == nullptr) return;
  const Mask colored = row.changes & Pack::Less(sdf, truncation);
  if (!Pack::Any(colored)) return;
  BlendColors<Pack, kAsksChanges>(view, pixel, blend, colored, leaf.color,
                                  changed);
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_ROW_H_
