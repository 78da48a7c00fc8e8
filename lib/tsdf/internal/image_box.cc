#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/tsdf/internal/image_box.h"

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/tsdf/internal/fuse_block.h"

namespace splitfusion {
namespace internal {
namespace {

using Points = SeenVoxels<EightLanes>;

SPLITFUSION_INLINE float LowestOf(const Lanes& numbers) {
  Lanes lowest = numbers;
  constexpr Flags kPartners[] = {{4, 5, 6, 7, 0, 1, 2, 3},
                                 {2, 3, 0, 1, 6, 7, 4, 5},
                                 {1, 0, 3, 2, 5, 4, 7, 6}};
  for (const Flags& partner : kPartners) {
    lowest = EightLanes::Min(lowest, __builtin_shuffle(lowest, partner));
  }
  return lowest[0];
}

/// Lowest z, u, v, -u and -v of points, lane by lane.
struct Bounds {
  static constexpr int kCount = 5;

  SPLITFUSION_INLINE void Add(const Points& points) {
    const Lanes inverse_z = 1 / points.z;
    const Lanes u = points.zu * inverse_z;
    const Lanes v = points.zv * inverse_z;
    const Lanes numbers[kCount] = {points.z, u, v, -u, -v};
    for (int k = 0; k < kCount; ++k) {
      lowest[k] = EightLanes::Min(numbers[k], lowest[k]);
    }
  }

  Lanes lowest[kCount] = {Lanes{} + 1e30f, Lanes{} + 1e30f, Lanes{} + 1e30f,
                          Lanes{} + 1e30f, Lanes{} + 1e30f};
};

/// The box that one lane of Bounds makes.
SPLITFUSION_INLINE ImageBox Box(const float lowest[Bounds::kCount]) {
  return {lowest[0] > kNear, lowest[0], lowest[1],
          -lowest[3],        lowest[2], -lowest[4]};
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
void BoundBlocks(const FusionView& view, const RigidBlock* blocks, int count,
                 const float steps[3][3], ImageBox* boxes) {
  constexpr float kEnd = kSide - 1;
  constexpr int kCorners = 8;
  float corners[kCorners][3] = {};  // From the base, as SeenPoint.
  for (int k = 0; k < 3; ++k) {
    const SeenPoint along(view, steps[k]);
    for (int i = 0; i < kCorners; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        corners[i][axis] += (i >> k & 1) != 0 ? kEnd * along.axes[axis] : 0;
      }
    }
  }
  for (int begin = 0; begin < count; begin += EightLanes::kCount) {
    // Lanes are blocks; beyond the last one it is bounded again.
    float bases[3][EightLanes::kCount];
    for (int lane = 0; lane < EightLanes::kCount; ++lane) {
      const RigidBlock& block = blocks[std::min(begin + lane, count - 1)];
      const SeenPoint start(view, block.base);
      for (int axis = 0; axis < 3; ++axis) bases[axis][lane] = start.axes[axis];
    }
    Points base;
    std::memcpy(&base.zu, bases[0], sizeof(base.zu));
    std::memcpy(&base.zv, bases[1], sizeof(base.zv));
    std::memcpy(&base.z, bases[2], sizeof(base.z));
    Bounds bounds;
    for (const auto& corner : corners) {
      bounds.Add(
          {base.zu + corner[0], base.zv + corner[1], base.z + corner[2]});
    }
    const int end = std::min(count - begin, EightLanes::kCount);
    for (int lane = 0; lane < end; ++lane) {
      float lowest[Bounds::kCount];
      for (int k = 0; k < Bounds::kCount; ++k)
        lowest[k] = bounds.lowest[k][lane];
      boxes[begin + lane] = Box(lowest);
    }
  }
}

SPLITFUSION_VECTOR_CLONES
ImageBox BoundLattice(const FusionView& view,
                      const float lattice[kLatticePoints][3]) {
  constexpr int kPacks =
      (kLatticePoints + EightLanes::kCount - 1) / EightLanes::kCount;
  Points points[kPacks];
  for (int i = 0; i < kPacks * EightLanes::kCount; ++i) {
    const SeenPoint point(view, lattice[i < kLatticePoints ? i : 0]);
    Points& pack = points[i / EightLanes::kCount];
    const int lane = i % EightLanes::kCount;
    pack.zu[lane] = point.axes[0];
    pack.zv[lane] = point.axes[1];
    pack.z[lane] = point.axes[2];
  }
  Bounds bounds;
  for (const Points& pack : points) bounds.Add(pack);
  float lowest[Bounds::kCount];
  for (int k = 0; k < Bounds::kCount; ++k) {
    lowest[k] = LowestOf(bounds.lowest[k]);
  }
  return Box(lowest);
}

}  // namespace internal
}  // namespace splitfusion
