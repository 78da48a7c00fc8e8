#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/tsdf/internal/image_box.h"

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/tsdf/internal/fuse_block.h"

namespace splitfusion {
namespace internal {
namespace {

using Points = SeenVoxels<EightLanes>;

/// The lowest of eight numbers, eight times.
SPLITFUSION_INLINE Lanes Lowest(const Lanes& numbers) {
  Lanes lowest = numbers;
  constexpr Flags kPartners[] = {{4, 5, 6, 7, 0, 1, 2, 3},
                                 {2, 3, 0, 1, 6, 7, 4, 5},
                                 {1, 0, 3, 2, 5, 4, 7, 6}};
  for (const Flags& partner : kPartners) {
    lowest = EightLanes::Min(lowest, __builtin_shuffle(lowest, partner));
  }
  return lowest;
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

  /// Of the points of one lane.
  SPLITFUSION_INLINE ImageBox Box(int lane) const {
    return {lowest[0][lane] > kNear, lowest[0][lane], lowest[1][lane],
            -lowest[3][lane],        lowest[2][lane], -lowest[4][lane]};
  }

  Lanes lowest[kCount] = {Lanes{} + 1e30f, Lanes{} + 1e30f, Lanes{} + 1e30f,
                          Lanes{} + 1e30f, Lanes{} + 1e30f};
};

/// Corners of a block, counted from its base, as SeenVoxels.
struct BlockCorners {
  SPLITFUSION_INLINE BlockCorners(const FusionView& view,
                                  const float steps[3][3]) {
    constexpr float kEnd = kSide - 1;
    for (int k = 0; k < 3; ++k) {
      const SeenPoint along(view, steps[k]);
      for (int i = 0; i < kCount; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          offsets[i][axis] += (i >> k & 1) != 0 ? kEnd * along.axes[axis] : 0;
        }
      }
    }
  }

  static constexpr int kCount = 8;
  float offsets[kCount][3] = {};
};

/// Bases of eight blocks from one on; beyond the last one that one again.
SPLITFUSION_INLINE Points Bases(const FusionView& view,
                                const RigidBlock* blocks, int begin,
                                int count) {
  float axes[3][EightLanes::kCount];
  for (int lane = 0; lane < EightLanes::kCount; ++lane) {
    const RigidBlock& block = blocks[std::min(begin + lane, count - 1)];
    const SeenPoint base(view, block.base);
    for (int axis = 0; axis < 3; ++axis) axes[axis][lane] = base.axes[axis];
  }
  Points bases;
  std::memcpy(&bases.zu, axes[0], sizeof(bases.zu));
  std::memcpy(&bases.zv, axes[1], sizeof(bases.zv));
  std::memcpy(&bases.z, axes[2], sizeof(bases.z));
  return bases;
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
void BoundBlocks(const FusionView& view, const RigidBlock* blocks, int count,
                 const float steps[3][3], ImageBox* boxes) {
  const BlockCorners corners(view, steps);
  for (int begin = 0; begin < count; begin += EightLanes::kCount) {
    const Points bases = Bases(view, blocks, begin, count);
    Bounds bounds;
    for (const auto& offset : corners.offsets) {
      bounds.Add(
          {bases.zu + offset[0], bases.zv + offset[1], bases.z + offset[2]});
    }
    const int end = std::min(count - begin, EightLanes::kCount);
    for (int lane = 0; lane < end; ++lane) {
      boxes[begin + lane] = bounds.Box(lane);
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
  for (Lanes& numbers : bounds.lowest) numbers = Lowest(numbers);
  return bounds.Box(0);
}

}  // namespace internal
}  // namespace splitfusion
