#pragma GCC optimize("no-trapping-math", "fp-contract=off")

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr int kSide = 8;              // Voxels along a block's edge.
constexpr int kSlab = kSide * kSide;  // Voxels with the same x.

/// Voxels of a slab as the camera sees them: z-depths in metres, and pixel
/// coordinates times z.
struct SeenSlab {
  float zu[kSlab], zv[kSlab], z[kSlab];
};

/// Pixels that they fall on.
struct SlabPixels {
  std::int32_t index[kSlab];
  FusionPixel pixel[kSlab];
};

/// What these say about the voxels.
struct SlabUpdate {
  float sdf[kSlab];         // Metres, positive in front.
  float confidence[kSlab];  // 0: nothing; negative: taken from the weight.
  float
      color_blend[kSlab];  // Weight of the pixel's colour, the rest the old's.
};

/// A point or a step of the camera frame as SeenSlab has it.
struct SeenPoint {
  SPLITFUSION_INLINE SeenPoint(const FusionView& view, const float p[3])
      : zu(view.fx * p[0] + view.cx * p[2]),
        zv(view.fy * p[1] + view.cy * p[2]),
        z(p[2]) {}
  float zu, zv, z;
};

/// The voxels of a block from a slab on.
SPLITFUSION_INLINE FusedLeaf SlabOf(const FusedLeaf& leaf, int x) {
  const int offset = x * kSlab;
  return {leaf.distance + offset, leaf.weight + offset,
          leaf.color == nullptr ? nullptr : leaf.color + offset};
}

/// Asks the memory for a slab of voxels.
SPLITFUSION_INLINE void Prefetch(const FusedLeaf& slab) {
  constexpr int kLine = 64 / sizeof(float);  // Of the cache.
  for (int i = 0; i < kSlab; i += kLine) {
    __builtin_prefetch(slab.distance + i, 1);
    __builtin_prefetch(slab.weight + i, 1);
    if (slab.color != nullptr) __builtin_prefetch(slab.color + i, 1);
  }
}

/// Looks pixels up; outside of the image the one that changes nothing.
SPLITFUSION_INLINE void LookUp(const FusionView& view, const SeenSlab& at,
                               SlabPixels* seen) {
  const auto width = static_cast<float>(view.width);
  const auto height = static_cast<float>(view.height);
  const std::int32_t nowhere = view.width * view.height;
  for (int i = 0; i < kSlab; ++i) {
    const float inverse_z = 1 / at.z[i];
    const float u = at.zu[i] * inverse_z + 0.5f;
    const float v = at.zv[i] * inverse_z + 0.5f;
    const bool inside = (at.z[i] > kNearPlane) & (u >= 0) & (v >= 0) &
                        (u < width) & (v < height);
    const auto column = static_cast<std::int32_t>(inside ? u : 0);
    const auto row = static_cast<std::int32_t>(inside ? v : 0);
    const std::int32_t index = row * view.width + column;
    seen->index[i] = inside ? index : nowhere;
  }
  for (int i = 0; i < kSlab; ++i) seen->pixel[i] = view.pixels[seen->index[i]];
}

/// Compares voxels with their pixels: ClassifyDepth() of
/// lib/geometry/depth_comparison.h as loops that are compiled for vectors.
/// Returns 0 if that changes none.
SPLITFUSION_INLINE int Compare(const FusionView& view, const SeenSlab& at,
                               const SlabPixels& seen, SlabUpdate* update) {
  const float truncation = view.truncation;
  int changes = 0;
  for (int i = 0; i < kSlab; ++i) {
    const FusionPixel pixel = seen.pixel[i];
    const float sdf = pixel.depth - at.z[i];
    const float behind = -ReachBehind(view, pixel.depth);
    const bool counts = sdf > (pixel.weight >= 0 ? behind : truncation);
    // That it is empty in front of what was measured, by more than noise, is
    // certain at any range, other than where a noisy ray ended.
    const bool is_free =
        sdf > truncation + kNoiseAlone.At(pixel.depth, view.noise);
    // Of a pixel that only carves, where one that writes would have written.
    const float refuted =
        sdf > behind ? std::min(view.refutation * pixel.weight, 0.0f) : 0;
    const float confidence = counts ? std::fabs(pixel.weight) : refuted;
    update->sdf[i] = sdf;
    update->confidence[i] = is_free ? 1 : confidence;
    changes |= update->confidence[i] != 0;
  }
  return changes;
}

/// Running means of distances, and weights. Returns other than 0 if a mesh may
/// show it.
SPLITFUSION_INLINE int BlendDistances(const FusionView& view,
                                      float* __restrict distances,
                                      float* __restrict weights,
                                      SlabUpdate* update) {
  const float truncation = view.truncation;
  int changed = 0;
  for (int i = 0; i < kSlab; ++i) {
    const float distance = distances[i], weight = weights[i];
    const float sdf = update->sdf[i], confidence = update->confidence[i];
    const float sum = std::max(weight + confidence, 0.0f);
    // No division by zero where neither voxel nor pixel has a weight.
    const float blend = std::max(confidence, 0.0f) / std::max(sum, 1e-30f);
    const float seen = std::max(-truncation, std::min(truncation, sdf));
    // A voxel that was refuted is as if it had never been observed.
    const bool forgotten = (confidence < 0) & (sum <= 0);
    const float mean =
        forgotten ? truncation : distance + blend * (seen - distance);
    const float capped = std::min(sum, view.max_weight);
    const bool is_soft = std::min(capped, weight) < kFirmWeight;
    changed |= (mean != distance) | (is_soft & (capped != weight));
    distances[i] = mean;
    weights[i] = capped;
    update->color_blend[i] = sdf < truncation ? blend : 0;
  }
  return changed;
}

/// Running means of colours, by channels. They are rounded up as often as they
/// are close to the upper value: else a small difference would never move them.
/// Returns other than 0 if one changes.
SPLITFUSION_INLINE int BlendColors(const FusionView& view,
                                   const SlabPixels& seen,
                                   const SlabUpdate& update,
                                   std::int32_t* __restrict color) {
  std::int32_t samples[kSlab];
  float dither[kSlab];
  for (int i = 0; i < kSlab; ++i) {
    samples[i] = view.color[seen.index[i]];
    dither[i] = view.dither[i % kSide];
  }
  int changed = 0;
  for (int i = 0; i < kSlab; ++i) {
    std::int32_t after = 0;
    for (int channel = 0; channel < 3; ++channel) {
      const auto mean = static_cast<float>(ChannelOf(color[i], channel));
      const auto sample = static_cast<float>(ChannelOf(samples[i], channel));
      const float next =
          mean + update.color_blend[i] * (sample - mean) + dither[i];
      after |= static_cast<std::int32_t>(next) << (channel * kChannelBits);
    }
    changed |= after ^ color[i];
    color[i] = after;
  }
  return changed;
}

/// Fuses what is seen into a slab. Returns other than 0 if a mesh may show it.
SPLITFUSION_INLINE int FuseSlab(const FusionView& view, const SeenSlab& at,
                                const SlabPixels& seen, const FusedLeaf& slab) {
  SlabUpdate update;
  if (Compare(view, at, seen, &update) == 0) return 0;
  const int changed = BlendDistances(view, slab.distance, slab.weight, &update);
  if (slab.color == nullptr) return changed;
  return changed | BlendColors(view, seen, update, slab.color);
}

/// One coordinate of a slab, given that of every fourth voxel of the block.
SPLITFUSION_INLINE void InterpolateSlab(const float lattice[kLatticePoints],
                                        int x, float slab[kSlab]) {
  const auto between = [](float a, float b, int i) {
    return a + static_cast<float>(i % 4) / 4 * (b - a);
  };
  float plane[9];
  for (int i = 0; i < 9; ++i) {
    const float* low = lattice + 9 * (x / 4) + i;
    plane[i] = between(low[0], low[9], x);
  }
  for (int y = 0; y < kSide; ++y) {
    float row[3];
    for (int z = 0; z < 3; ++z) {
      const float* low = plane + 3 * (y / 4) + z;
      row[z] = between(low[0], low[3], y);
    }
    for (int z = 0; z < kSide; ++z) {
      slab[kSide * y + z] = between(row[z / 4], row[z / 4 + 1], z);
    }
  }
}

/// Makes the pixels of voxels in foreign cells only carve; `foreign`: the four
/// cells of the slab.
SPLITFUSION_INLINE void MarkForeign(const bool foreign[4], SlabPixels* seen) {
  for (int i = 0; i < kSlab; ++i) {
    float* weight = &seen->pixel[i].weight;
    if (foreign[2 * (i / 32) + i / 4 % 2]) *weight = -std::fabs(*weight);
  }
}

}  // namespace

SPLITFUSION_WIDEST_VECTOR_CLONES
bool FuseRigidLeaf(const FusionView& view, const float steps[3][3],
                   const RigidLeaf& rigid, const FusedLeaf& next) {
  const FusionView local = view;  // Which no voxel's address can be that of.
  const SeenPoint base(local, rigid.base), along_x(local, steps[0]);
  const SeenPoint along_y(local, steps[1]), along_z(local, steps[2]);
  constexpr float kEnd = kSide - 1;
  const float nearest =  // Of a slab, counted from its first voxel.
      std::min(kEnd * along_y.z, 0.0f) + std::min(kEnd * along_z.z, 0.0f);
  int changed = 0;
  for (int slab = 0; slab < kSide; ++slab) {
    Prefetch(SlabOf(next, slab));
    const auto x = static_cast<float>(slab);
    if (base.z + x * along_x.z + nearest > rigid.farthest) continue;
    SeenSlab at;
    for (int i = 0; i < kSlab; ++i) {
      const auto y = static_cast<float>(i / kSide);
      const auto z = static_cast<float>(i % kSide);
      at.zu[i] = base.zu + x * along_x.zu + (y * along_y.zu + z * along_z.zu);
      at.zv[i] = base.zv + x * along_x.zv + (y * along_y.zv + z * along_z.zv);
      at.z[i] = base.z + x * along_x.z + (y * along_y.z + z * along_z.z);
    }
    SlabPixels seen;
    LookUp(local, at, &seen);
    changed |= FuseSlab(local, at, seen, SlabOf(rigid.leaf, slab));
  }
  return changed != 0;
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool FuseWarpedLeaf(const FusionView& view,
                    const float lattice[kLatticePoints][3],
                    const bool foreign[kLatticeCells], const FusedLeaf& leaf) {
  const FusionView local = view;
  float zu[kLatticePoints], zv[kLatticePoints], z[kLatticePoints];
  for (int i = 0; i < kLatticePoints; ++i) {
    const SeenPoint point(local, lattice[i]);
    zu[i] = point.zu, zv[i] = point.zv, z[i] = point.z;
  }
  int changed = 0;
  for (int x = 0; x < kSide; ++x) {
    SeenSlab at;
    InterpolateSlab(zu, x, at.zu);
    InterpolateSlab(zv, x, at.zv);
    InterpolateSlab(z, x, at.z);
    SlabPixels seen;
    LookUp(local, at, &seen);
    MarkForeign(foreign + 4 * (x / 4), &seen);
    changed |= FuseSlab(local, at, seen, SlabOf(leaf, x));
  }
  return changed != 0;
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool HasInside(const FusedLeaf& leaf) {
  int inside = 0;
  for (int i = 0; i < kSide * kSlab; ++i) {
    inside |= (leaf.distance[i] <= 0) & (leaf.weight[i] > 0);
  }
  return inside != 0;
}

}  // namespace internal
}  // namespace splitfusion
