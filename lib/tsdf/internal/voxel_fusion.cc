#pragma GCC optimize("no-trapping-math", "fp-contract=off")

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/geometry/depth_noise.h"
#include "splitfusion/lib/tsdf/internal/lanes.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr int kSize = kLanes;  // Voxels along a block's edge.
constexpr float kNear = 0.05f;

/// A voxel that is clearly in front of what was measured is empty. That counts
/// more than where a noisy ray ended, whatever the range: a limb that moved on
/// is gone within a few frames.
constexpr float kFreeSpaceWeight = 3.0f;

/// ... which it is for sure where it is nearer than the measured depth by the
/// truncation and as many sigma of the depth.
constexpr float kFreeSpaceSigmas = 3.0f;

/// Pixels that points of the camera frame fall on; outside of the image the one
/// that changes nothing. With `kAllInside` none is outside.
template <bool kAllInside>
SPLITFUSION_INLINE void Project(const FusionView& view, const Lanes& x,
                                const Lanes& y, const Lanes& z, Flags* pixel) {
  const Lanes inverse_z = 1 / z;
  Flags u, v;
  Round(view.fx * x * inverse_z + view.cx, &u);
  Round(view.fy * y * inverse_z + view.cy, &v);
  *pixel = v * view.width + u;
  if (kAllInside) return;
  const Flags inside =
      (z > kNear) & (u >= 0) & (v >= 0) & (u < view.width) & (v < view.height);
  *pixel = inside ? *pixel : Flags{} + view.width * view.height;
}

/// The records of eight pixels, field by field.
struct PixelRow {
  Lanes depth, weight;
  Flags carves;  // Of another surface.
};

/// Reads eight records of two floats and turns them round.
SPLITFUSION_INLINE void Gather(const FusionView& view,
                               const std::int32_t pixel[kSize], PixelRow* row) {
  using Record = double;
  using Records = Record __attribute__((vector_size(sizeof(Lanes))));
  static_assert(sizeof(FusionPixel) == sizeof(Record));
  Record record[kSize];
  for (int i = 0; i < kSize; ++i) {
    std::memcpy(&record[i], view.pixels + pixel[i], sizeof(Record));
  }
  const Records first = {record[0], record[1], record[4], record[5]};
  const Records second = {record[2], record[3], record[6], record[7]};
  Lanes low, high, weight;
  std::memcpy(&low, &first, sizeof(low));
  std::memcpy(&high, &second, sizeof(high));
  row->depth = __builtin_shuffle(low, high, Flags{0, 2, 8, 10, 4, 6, 12, 14});
  weight = __builtin_shuffle(low, high, Flags{1, 3, 9, 11, 5, 7, 13, 15});
  Flags bits;
  std::memcpy(&bits, &weight, sizeof(bits));
  row->carves = bits < 0;
  bits &= INT32_MAX;
  std::memcpy(&row->weight, &bits, sizeof(bits));
}

/// splitfusion::DepthSigma() of eight depths.
SPLITFUSION_INLINE void DepthSigma(const Lanes& depth, Lanes* sigma) {
  const Lanes d = depth - static_cast<float>(kBestDepth);
  *sigma = static_cast<float>(kLeastDepthSigma) +
           static_cast<float>(kDepthSigmaGrowth) * d * d;
}

/// The three channels of eight voxels, one voxel after the other: which voxel
/// a number belongs to, and where its channel begins in a pixel's bits.
constexpr std::int32_t kVoxelOf[3 * kSize] = {
    0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7};
constexpr std::int32_t kShiftOf[3 * kSize] = {0,  8,  16, 0,  8,  16, 0,  8,
                                              16, 0,  8,  16, 0,  8,  16, 0,
                                              8,  16, 0,  8,  16, 0,  8,  16};

/// Running means of eight numbers of the colours of eight voxels.
SPLITFUSION_INLINE void BlendColorPart(int begin, const Flags& rgb,
                                       const Lanes& blend, const Flags& colored,
                                       float* color, Flags* changed) {
  Flags voxel, shift;
  std::memcpy(&voxel, kVoxelOf + begin, sizeof(voxel));
  std::memcpy(&shift, kShiftOf + begin, sizeof(shift));
  const Flags byte = (__builtin_shuffle(rgb, voxel) >> shift) & 255;
  const Lanes value = __builtin_convertvector(byte, Lanes) / 255.0f;
  Lanes before;
  Load(color + begin, &before);
  const Lanes after =
      before + __builtin_shuffle(blend, voxel) * (value - before);
  const Lanes kept = __builtin_shuffle(colored, voxel) ? after : before;
  Store(kept, color + begin);
  *changed |= kept != before;
}

/// Running means of the colours of eight voxels.
SPLITFUSION_INLINE void BlendColors(const FusionView& view,
                                    const std::int32_t pixel[kSize],
                                    const Lanes& blend, const Flags& colored,
                                    float* color, Flags* changed) {
  const std::int32_t* rgb = view.rgb;
  const Flags seen = {rgb[pixel[0]], rgb[pixel[1]], rgb[pixel[2]],
                      rgb[pixel[3]], rgb[pixel[4]], rgb[pixel[5]],
                      rgb[pixel[6]], rgb[pixel[7]]};
  BlendColorPart(0, seen, blend, colored, color, changed);
  BlendColorPart(8, seen, blend, colored, color, changed);
  BlendColorPart(16, seen, blend, colored, color, changed);
}

/// Fuses into eight voxels in a row, given their pixels, their depths and which
/// of them are foreign; notes where a mesh may show it. Returns whether there
/// was colour to be fused.
SPLITFUSION_INLINE bool FuseRow(const FusionView& view,
                                const std::int32_t pixel[kSize], const Lanes& z,
                                const Flags& foreign, const FusedLeaf& leaf,
                                Flags* changed) {
  PixelRow row;
  Gather(view, pixel, &row);
  const Lanes truncation = Lanes{} + view.truncation;
  const Flags carves = row.carves | foreign;
  const Lanes sdf = row.depth - z;
  Flags changes = (sdf > truncation) | (~carves & (sdf >= -truncation));
  if (!Any(changes)) return false;
  Lanes old_distance, old_weight;
  Load(leaf.distance, &old_distance);
  Load(leaf.weight, &old_weight);
  Lanes sigma;
  DepthSigma(row.depth, &sigma);
  const Flags free_space = sdf > truncation + kFreeSpaceSigmas * sigma;
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
  Store(distance, leaf.distance);
  Store(weight, leaf.weight);
  const Lanes lower = weight < old_weight ? weight : old_weight;
  *changed |= (distance != old_distance) |
              ((weight != old_weight) & (lower < kFirmWeight));
  if (leaf.color == nullptr) return false;
  const Flags colored =
      changes & ~carves & (sdf < truncation) & (sdf > -truncation);
  if (!Any(colored)) return false;
  BlendColors(view, pixel, blend, colored, leaf.color, changed);
  return true;
}

/// The row of a block that begins at a voxel.
SPLITFUSION_INLINE FusedLeaf RowAt(const FusedLeaf& leaf, int offset) {
  return {leaf.distance + offset, leaf.weight + offset,
          leaf.color == nullptr ? nullptr : leaf.color + 3 * offset};
}

/// Asks the memory for one slab of a block, and for its colours if it is
/// `with_color`.
SPLITFUSION_INLINE void PrefetchSlab(const FusedLeaf& leaf, int x,
                                     bool with_color) {
  constexpr int kLine = 64 / sizeof(float);
  const FusedLeaf slab = RowAt(leaf, x * kSize * kSize);
  for (int i = 0; i < kSize * kSize; i += kLine) {
    __builtin_prefetch(slab.distance + i, 1);
    __builtin_prefetch(slab.weight + i, 1);
  }
  for (int i = 0; i < 3 * kSize * kSize && with_color; i += kLine) {
    __builtin_prefetch(slab.color + i, 1);
  }
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

/// Pixels and depths of the 8 x 8 voxels of a slab; [i][k]: voxel (i, k).
struct Slab {
  std::int32_t pixel[kSize][kSize];  // By z and y.
  Lanes z[kSize];                    // By y and z.
};

/// The slab whose first voxel is at `base`.
template <bool kAllInside>
SPLITFUSION_INLINE void ProjectSlab(const FusionView& view, const float base[3],
                                    const float steps[3][3], Slab* slab) {
  // Lanes are along y here: z is summed up step by step.
  const Lanes ramp = {0, 1, 2, 3, 4, 5, 6, 7};
  Lanes p[3];
  for (int axis = 0; axis < 3; ++axis) {
    p[axis] = base[axis] + ramp * steps[1][axis];
  }
  for (int z = 0; z < kSize; ++z) {
    Flags pixel;
    Project<kAllInside>(view, p[0], p[1], p[2], &pixel);
    std::memcpy(slab->pixel[z], &pixel, sizeof(pixel));
    slab->z[z] = p[2];
    for (int axis = 0; axis < 3; ++axis) p[axis] += steps[2][axis];
  }
  Transpose(slab->z);
}

SPLITFUSION_INLINE float Lower(float a, float b) { return b < a ? b : a; }

template <bool kAllInside>
SPLITFUSION_INLINE bool FuseRigid(const FusionView& view, const float base[3],
                                  const float steps[3][3], float farthest,
                                  const FusedLeaf& leaf) {
  // Nearest voxel of a row and of a slab, from their first ones.
  const float row_low = Lower(0, (kSize - 1) * steps[2][2]);
  const float slab_low = row_low + Lower(0, (kSize - 1) * steps[1][2]);
  Flags changed = {};
  bool colored = false;  // Something of the slab before.
  for (int x = 0; x < kSize; ++x) {
    // Colours are few blocks' and cluster.
    if (x + 1 < kSize) PrefetchSlab(leaf, x + 1, colored);
    colored = false;
    float corner[3];
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis] = base[axis] + static_cast<float>(x) * steps[0][axis];
    }
    if (corner[2] + slab_low > farthest) continue;
    Slab slab;
    ProjectSlab<kAllInside>(view, corner, steps, &slab);
    float row_z = corner[2] + row_low;
    for (int y = 0; y < kSize; ++y, row_z += steps[1][2]) {
      if (row_z > farthest) continue;
      std::int32_t pixel[kSize];
      for (int z = 0; z < kSize; ++z) pixel[z] = slab.pixel[z][y];
      colored |= FuseRow(view, pixel, slab.z[y], Flags{},
                         RowAt(leaf, (x * kSize + y) * kSize), &changed);
    }
  }
  return Any(changed);
}

}  // namespace

SPLITFUSION_WIDEST_VECTOR_CLONES
bool FuseRigidLeaf(const FusionView& view, const float base[3],
                   const float steps[3][3], const FusedPart& part,
                   const FusedLeaf& leaf) {
  const FusionView local = view;  // Which no voxel's address can be that of.
  return part.in_image
             ? FuseRigid<true>(local, base, steps, part.farthest, leaf)
             : FuseRigid<false>(local, base, steps, part.farthest, leaf);
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool FuseWarpedLeaf(const FusionView& view,
                    const float lattice[kLatticePoints][3],
                    const bool foreign[kLatticeCells], const FusedLeaf& leaf) {
  const FusionView local = view;
  Flags changed = {};
  for (int x = 0; x < kSize; ++x) {
    float plane[9][3];
    InterpolateX(lattice, x, plane);
    for (int y = 0; y < kSize; ++y) {
      Lanes p[3];
      for (int axis = 0; axis < 3; ++axis) {
        InterpolateRow(plane, y, axis, &p[axis]);
      }
      Flags pixels;
      Project<false>(local, p[0], p[1], p[2], &pixels);
      std::int32_t pixel[kSize];
      std::memcpy(pixel, &pixels, sizeof(pixel));
      const bool* cells = foreign + 4 * (x / 4) + 2 * (y / 4);
      const std::int32_t a = -cells[0], b = -cells[1];
      FuseRow(local, pixel, p[2], Flags{a, a, a, a, b, b, b, b},
              RowAt(leaf, (x * kSize + y) * kSize), &changed);
    }
  }
  return Any(changed);
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool HasInside(const FusedLeaf& leaf) {
  Flags inside = {};
  for (int i = 0; i < kSize * kSize * kSize; i += kSize) {
    Lanes distance, weight;
    Load(leaf.distance + i, &distance);
    Load(leaf.weight + i, &weight);
    inside |= (distance <= 0) & (weight > 0);
  }
  return Any(inside);
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
