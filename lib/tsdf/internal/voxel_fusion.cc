#pragma GCC optimize("no-trapping-math", "fp-contract=off")

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/tsdf/internal/fuse_block.h"
#include "splitfusion/lib/tsdf/internal/rigid_fusion.h"

namespace splitfusion {
namespace internal {
namespace {

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
  const Lanes along = {0, 0.25f, 0.5f, 0.75f, 0, 0.25f, 0.5f, 0.75f};  // Maths.
  *row = begin + along * (end - begin);
}

void FuseRigidAnywhere(const FusionView& view, const float steps[3][3],
                       RigidBlock* blocks, int count) {
  const FusionView local = view;  // Which no voxel's address can be that of.
  FuseRigid<EightLanes>(local, steps, blocks, count);
}

RigidFusion FastestFusion() {
  for (const RigidFusion fuse : {Avx512Fusion(), Avx2Fusion()}) {
    if (fuse != nullptr) return fuse;
  }
  return PortableFusion();
}

}  // namespace

RigidFusion PortableFusion() { return FuseRigidAnywhere; }

void FuseRigidBlocks(const FusionView& view, const float steps[3][3],
                     RigidBlock* blocks, int count) {
  static const RigidFusion fuse = FastestFusion();
  fuse(view, steps, blocks, count);
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool FuseWarpedLeaf(const FusionView& view,
                    const float lattice[kLatticePoints][3],
                    const bool foreign[kLatticeCells], const FusedLeaf& leaf) {
  const FusionView local = view;
  float seen[kLatticePoints][3];
  for (int i = 0; i < kLatticePoints; ++i) {
    const SeenPoint point(local, lattice[i]);
    std::memcpy(seen[i], point.axes, sizeof(point.axes));
  }
  SeenSlabs<EightLanes> slab;
  static_assert(slab.kSlabs == 1);
  Flags changed = {};
  for (int x = 0; x < kSide; ++x) {
    float plane[9][3];
    InterpolateX(seen, x, plane);
    for (int y = 0; y < kSide; ++y) {
      SeenVoxels<EightLanes> at;
      InterpolateRow(plane, y, 0, &at.zu);
      InterpolateRow(plane, y, 1, &at.zv);
      InterpolateRow(plane, y, 2, &at.z);
      const Flags pixel = PixelsOf<EightLanes, false>(local, at);
      std::memcpy(slab.pixel[y], &pixel, sizeof(pixel));
      slab.z[y] = at.z;
      const bool* cells = foreign + 4 * (x / 4) + 2 * (y / 4);
      const std::int32_t a = cells[0] ? INT32_MIN : 0;
      const std::int32_t b = cells[1] ? INT32_MIN : 0;
      slab.foreign[y] = Flags{a, a, a, a, b, b, b, b};
    }
    const int next = std::min(x + 1, kSide - 1);
    FuseSlabs<EightLanes, true>(local, slab, VoxelsFrom(leaf, x * kSlab),
                                VoxelsFrom(leaf, next * kSlab), &changed);
  }
  return EightLanes::Any(EightLanes::NotZero(changed));
}

SPLITFUSION_WIDEST_VECTOR_CLONES
bool HasInside(const FusedLeaf& leaf) { return HasInsideBy<EightLanes>(leaf); }

}  // namespace internal
}  // namespace splitfusion
