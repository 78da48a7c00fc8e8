#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/tsdf/internal/image_box.h"

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

/// Box around `count` times eight points.
SPLITFUSION_INLINE ImageBox BoundPoints(const Points* points, int count) {
  Lanes z_low = points[0].z;
  Lanes u_low = Lanes{} + 1e30f, v_low = u_low;
  Lanes minus_u_low = u_low, minus_v_low = u_low;
  for (int i = 0; i < count; ++i) {
    const Lanes inverse_z = 1 / points[i].z;
    const Lanes u = points[i].zu * inverse_z;
    const Lanes v = points[i].zv * inverse_z;
    z_low = EightLanes::Min(points[i].z, z_low);
    u_low = EightLanes::Min(u, u_low);
    v_low = EightLanes::Min(v, v_low);
    minus_u_low = EightLanes::Min(-u, minus_u_low);
    minus_v_low = EightLanes::Min(-v, minus_v_low);
  }
  ImageBox box;
  box.z_low = LowestOf(z_low);
  box.in_front = box.z_low > kNear;
  box.u_low = LowestOf(u_low);
  box.v_low = LowestOf(v_low);
  box.u_high = -LowestOf(minus_u_low);
  box.v_high = -LowestOf(minus_v_low);
  return box;
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
ImageBox BoundBlock(const FusionView& view, const float base[3],
                    const float steps[3][3]) {
  constexpr float kEnd = kSide - 1;
  const Lanes x = {0, kEnd, 0, kEnd, 0, kEnd, 0, kEnd};
  const Lanes y = {0, 0, kEnd, kEnd, 0, 0, kEnd, kEnd};
  const Lanes z = {0, 0, 0, 0, kEnd, kEnd, kEnd, kEnd};
  const SeenPoint start(view, base);
  const SeenPoint along_x(view, steps[0]), along_y(view, steps[1]),
      along_z(view, steps[2]);
  Lanes corners[3];
  for (int axis = 0; axis < 3; ++axis) {
    corners[axis] = start.axes[axis] + x * along_x.axes[axis] +
                    y * along_y.axes[axis] + z * along_z.axes[axis];
  }
  const Points points = {corners[0], corners[1], corners[2]};
  return BoundPoints(&points, 1);
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
  return BoundPoints(points, kPacks);
}

}  // namespace internal
}  // namespace splitfusion
