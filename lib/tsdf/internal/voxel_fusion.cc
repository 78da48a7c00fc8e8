#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"

// The functions that work on vectors are inlined into their callers, once for
// every instruction set.
#define SPLITFUSION_INLINE inline __attribute__((always_inline))

namespace splitfusion {
namespace internal {
namespace {

constexpr int kSize = 8;  // Voxels along a block's edge.
constexpr float kNear = 0.05f;

/// A voxel that is clearly in front of what was measured is empty. That counts
/// more than where a noisy ray ended, whatever the range: a limb that moved on
/// is gone within a few frames.
constexpr float kFreeSpaceWeight = 3.0f;

using Lanes = float __attribute__((vector_size(sizeof(float) * kSize)));
using Flags = std::int32_t __attribute__((vector_size(sizeof(float) * kSize)));

/// One slab of a block's voxels: pixel and depth of every voxel.
struct Slab {
  Flags pixel[kSize];
  Lanes z[kSize];
};

SPLITFUSION_INLINE void Load(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

/// The nearest integers, halves away from zero like std::lround.
SPLITFUSION_INLINE void Round(const Lanes& x, Flags* nearest) {
  const Lanes half = x < 0 ? (Lanes{} - 0.49999997f) : (Lanes{} + 0.49999997f);
  *nearest = __builtin_convertvector(x + half, Flags);
}

/// Pixels that points of the camera frame fall on; outside of the image the one
/// that changes nothing.
SPLITFUSION_INLINE void Project(const FusionView& view, const Lanes& x,
                                const Lanes& y, const Lanes& z, Flags* pixel) {
  const Lanes inverse_z = 1 / z;
  Flags u, v;
  Round(view.fx * x * inverse_z + view.cx, &u);
  Round(view.fy * y * inverse_z + view.cy, &v);
  const Flags inside =
      (z > kNear) & (u >= 0) & (v >= 0) & (u < view.width) & (v < view.height);
  const Flags none = Flags{} + view.width * view.height;
  *pixel = inside ? v * view.width + u : none;
}

SPLITFUSION_INLINE bool Any(const Flags& flags) {
  std::int64_t words[kSize / 2];
  std::memcpy(words, &flags, sizeof(words));
  return (words[0] | words[1] | words[2] | words[3]) != 0;
}

/// Running mean of a colour, channel by channel.
SPLITFUSION_INLINE bool BlendColor(const std::uint8_t* bgr, float blend,
                                   float* rgb) {
  bool changed = false;
  for (int channel = 0; channel < 3; ++channel) {
    const float before = rgb[channel];
    rgb[channel] += blend * (bgr[2 - channel] / 255.0f - before);
    changed |= rgb[channel] != before;
  }
  return changed;
}

/// The records of eight pixels, field by field.
struct PixelRow {
  Lanes depth, weight, change_from, free_above;
};

/// Reads eight records of four floats and turns them round.
SPLITFUSION_INLINE void Gather(const FusionView& view,
                               const std::int32_t pixel[kSize], PixelRow* row) {
  static_assert(sizeof(FusionPixel) == 4 * sizeof(float));
  using Record = float __attribute__((vector_size(sizeof(FusionPixel))));
  Lanes pair[4];  // Pixels i and i + 4.
  for (int i = 0; i < 4; ++i) {
    Record one, other;
    std::memcpy(&one, view.pixels + pixel[i], sizeof(one));
    std::memcpy(&other, view.pixels + pixel[i + 4], sizeof(other));
    pair[i] = __builtin_shufflevector(one, other, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Flags low = {0, 8, 1, 9, 4, 12, 5, 13};
  const Flags high = {2, 10, 3, 11, 6, 14, 7, 15};
  const Flags first = {0, 1, 8, 9, 4, 5, 12, 13};
  const Flags second = {2, 3, 10, 11, 6, 7, 14, 15};
  const Lanes low01 = __builtin_shuffle(pair[0], pair[1], low);
  const Lanes low23 = __builtin_shuffle(pair[2], pair[3], low);
  const Lanes high01 = __builtin_shuffle(pair[0], pair[1], high);
  const Lanes high23 = __builtin_shuffle(pair[2], pair[3], high);
  row->depth = __builtin_shuffle(low01, low23, first);
  row->weight = __builtin_shuffle(low01, low23, second);
  row->change_from = __builtin_shuffle(high01, high23, first);
  row->free_above = __builtin_shuffle(high01, high23, second);
}

/// Fuses into eight voxels in a row, given their pixels, their depths and the
/// distance from which on they may be changed; returns whether a mesh may show
/// it.
SPLITFUSION_INLINE bool FuseRow(const FusionView& view,
                                const std::int32_t pixel[kSize], const Lanes& z,
                                const Lanes& change_from,
                                const FusedLeaf& leaf) {
  PixelRow row;
  Gather(view, pixel, &row);
  row.change_from =
      row.change_from < change_from ? change_from : row.change_from;
  const Lanes sdf = row.depth - z;
  Flags changes = sdf >= row.change_from;
  if (!Any(changes)) return false;
  Lanes old_distance, old_weight;
  Load(leaf.distance, &old_distance);
  Load(leaf.weight, &old_weight);
  const Lanes truncation = Lanes{} + view.truncation;
  const Flags free_space = sdf > row.free_above;
  const Lanes confidence = free_space ? Lanes{} + kFreeSpaceWeight : row.weight;
  const Lanes sum = old_weight + confidence;
  changes &= sum > 0;
  const Lanes blend = confidence / sum;
  const Lanes sample = truncation < sdf ? truncation : sdf;
  Lanes distance = old_distance + blend * (sample - old_distance);
  const Flags emptied = free_space & (distance > 0.9f * view.truncation);
  const Lanes cap =
      emptied ? Lanes{} + view.max_free_weight : Lanes{} + view.max_weight;
  Lanes weight = cap < sum ? cap : sum;
  distance = changes ? distance : old_distance;
  weight = changes ? weight : old_weight;
  std::memcpy(leaf.distance, &distance, sizeof(Lanes));
  std::memcpy(leaf.weight, &weight, sizeof(Lanes));
  const Lanes lower = weight < old_weight ? weight : old_weight;
  bool changed = Any((distance != old_distance) |
                     ((weight != old_weight) & (lower < kFirmWeight)));
  const Flags colored = changes & (row.change_from < 0) & (sdf < truncation) &
                        (sdf > -truncation);
  const bool any_colored = Any(colored);
  for (int i = 0; i < kSize && any_colored; ++i) {
    if (colored[i] == 0) continue;
    changed |=
        BlendColor(view.color + 3 * pixel[i], blend[i], leaf.color + 3 * i);
  }
  return changed;
}

/// The row of a block that begins at a voxel.
SPLITFUSION_INLINE FusedLeaf RowAt(const FusedLeaf& leaf, int offset) {
  return {leaf.distance + offset, leaf.weight + offset,
          leaf.color + 3 * offset};
}

/// Lattice of a block interpolated to one x: 3 x 3 points by y and z.
SPLITFUSION_INLINE void InterpolateX(const float lattice[kLatticePoints][3],
                                     int x, float plane[9][3]) {
  const int low = 9 * (x / 4);
  const float fraction = static_cast<float>(x % 4) / 4;
  for (int i = 0; i < 9; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const float a = lattice[low + i][axis];
      plane[i][axis] = a + fraction * (lattice[low + 9 + i][axis] - a);
    }
  }
}

/// Coordinate of a plane's row of eight voxels at one y.
SPLITFUSION_INLINE void InterpolateRow(const float plane[9][3], int y, int axis,
                                       Lanes* row) {
  const int low = 3 * (y / 4);
  const float fraction = static_cast<float>(y % 4) / 4;
  float column[3];
  for (int z = 0; z < 3; ++z) {
    const float a = plane[low + z][axis];
    column[z] = a + fraction * (plane[low + 3 + z][axis] - a);
  }
  const Lanes begin = {column[0], column[0], column[0], column[0],
                       column[1], column[1], column[1], column[1]};
  const Lanes end = {column[1], column[1], column[1], column[1],
                     column[2], column[2], column[2], column[2]};
  const Lanes along = {0, 0.25f, 0.5f, 0.75f, 0, 0.25f, 0.5f, 0.75f};
  *row = begin + along * (end - begin);
}

/// Distance from which on the voxels of a row in two cells may be changed.
SPLITFUSION_INLINE void ChangeFrom(const FusionView& view,
                                   const bool foreign[2], Lanes* from) {
  const float a = foreign[0] ? view.beyond_truncation : -view.truncation;
  const float b = foreign[1] ? view.beyond_truncation : -view.truncation;
  *from = Lanes{a, a, a, a, b, b, b, b};
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
bool FuseRigidLeaf(const FusionView& view, const float base[3],
                   const float steps[3][3], const FusedLeaf& leaf) {
  bool changed = false;
  const Lanes ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int x = 0; x < kSize; ++x) {
    // Lanes are along y here: z is summed up step by step.
    Lanes p[3];
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = (base[axis] + static_cast<float>(x) * steps[0][axis]) +
                ramp * steps[1][axis];
    }
    Slab slab;
    for (int z = 0; z < kSize; ++z) {
      Project(view, p[0], p[1], p[2], &slab.pixel[z]);
      slab.z[z] = p[2];
      for (int axis = 0; axis < 3; ++axis) p[axis] += steps[2][axis];
    }
    for (int y = 0; y < kSize; ++y) {
      std::int32_t pixel[kSize];
      for (int z = 0; z < kSize; ++z) pixel[z] = slab.pixel[z][y];
      const Lanes z_row = {slab.z[0][y], slab.z[1][y], slab.z[2][y],
                           slab.z[3][y], slab.z[4][y], slab.z[5][y],
                           slab.z[6][y], slab.z[7][y]};
      changed |= FuseRow(view, pixel, z_row, Lanes{} - view.truncation,
                         RowAt(leaf, (x * kSize + y) * kSize));
    }
  }
  return changed;
}

SPLITFUSION_VECTOR_CLONES
bool FuseWarpedLeaf(const FusionView& view,
                    const float lattice[kLatticePoints][3],
                    const bool foreign[kLatticeCells], const FusedLeaf& leaf) {
  bool changed = false;
  for (int x = 0; x < kSize; ++x) {
    float plane[9][3];
    InterpolateX(lattice, x, plane);
    for (int y = 0; y < kSize; ++y) {
      Lanes p[3];
      for (int axis = 0; axis < 3; ++axis) {
        InterpolateRow(plane, y, axis, &p[axis]);
      }
      Flags pixels;
      Project(view, p[0], p[1], p[2], &pixels);
      std::int32_t pixel[kSize];
      std::memcpy(pixel, &pixels, sizeof(pixel));
      Lanes change_from;
      ChangeFrom(view, foreign + 4 * (x / 4) + 2 * (y / 4), &change_from);
      changed |= FuseRow(view, pixel, p[2], change_from,
                         RowAt(leaf, (x * kSize + y) * kSize));
    }
  }
  return changed;
}

ImageBox BoundInImage(const FusionView& view, const float (*points)[3],
                      int count) {
  ImageBox box;
  box.z_low = points[0][2];
  for (int i = 0; i < count; ++i) box.z_low = std::min(box.z_low, points[i][2]);
  box.in_front = box.z_low > kNear;
  if (!box.in_front) return box;
  box.u_low = box.v_low = 1e30f;
  box.u_high = box.v_high = -1e30f;
  for (int i = 0; i < count; ++i) {
    const float u = view.fx * points[i][0] / points[i][2] + view.cx;
    const float v = view.fy * points[i][1] / points[i][2] + view.cy;
    box.u_low = std::min(box.u_low, u);
    box.u_high = std::max(box.u_high, u);
    box.v_low = std::min(box.v_low, v);
    box.v_high = std::max(box.v_high, v);
  }
  return box;
}

}  // namespace internal
}  // namespace splitfusion
