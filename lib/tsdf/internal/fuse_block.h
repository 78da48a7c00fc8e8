#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_

#include "splitfusion/lib/tsdf/internal/fuse_row.h"
#include "splitfusion/lib/tsdf/internal/lanes.h"
#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

constexpr int kSide = 8;              ///< Voxels along a block's edge.
constexpr int kSlab = kSide * kSide;  ///< Voxels with the same x.

/// The voxels of a block from one on.
SPLITFUSION_INLINE FusedLeaf VoxelsFrom(const FusedLeaf& leaf, int offset) {
  return {leaf.distance + offset, leaf.weight + offset,
          leaf.color == nullptr ? nullptr : leaf.color + offset};
}

/// Asks the memory for one slab of a block.
SPLITFUSION_INLINE void PrefetchSlab(const FusedLeaf& leaf, int x) {
  constexpr int kLine = 64 / sizeof(float);
  for (int i = x * kSlab; i < (x + 1) * kSlab; i += kLine) {
    __builtin_prefetch(leaf.distance + i, 1);
    __builtin_prefetch(leaf.weight + i, 1);
    if (leaf.color != nullptr) __builtin_prefetch(leaf.color + i, 1);
  }
}

/// The voxels of a slab as the camera sees them, pack by pack.
template <typename Pack>
struct SeenSlab {
  static constexpr int kPacks = kSlab / Pack::kCount;

  std::int32_t pixel[kPacks][Pack::kCount];
  typename Pack::Real z[kPacks];         ///< Metres.
  typename Pack::Whole foreign[kPacks];  ///< With a minus: only carved.
  bool hidden[kPacks];                   ///< Nothing of the pack can change.
};

/// Fuses into a slab. All packs are looked up before the first is written: that
/// hides the latency of the image.
template <typename Pack>
SPLITFUSION_INLINE void FuseSlab(const FusionView& view,
                                 const SeenSlab<Pack>& slab,
                                 const FusedLeaf& leaf,
                                 typename Pack::Whole* changed) {
  SeenRow<Pack> rows[slab.kPacks];
  for (int i = 0; i < slab.kPacks; ++i) {
    if (slab.hidden[i]) {
      rows[i].changes = typename Pack::Mask{};
    } else {
      SeeRow<Pack>(view, slab.pixel[i], slab.z[i], slab.foreign[i], &rows[i]);
    }
  }
  for (int i = 0; i < slab.kPacks; ++i) {
    if (!Pack::Any(rows[i].changes)) continue;
    FuseRow<Pack>(view, slab.pixel[i], slab.z[i], rows[i],
                  VoxelsFrom(leaf, i * Pack::kCount), changed);
  }
}

/// A point or a step of the camera frame as SeenVoxels has it.
struct SeenPoint {
  SPLITFUSION_INLINE SeenPoint(const FusionView& view, const float p[3])
      : axes{view.fx * p[0] + view.cx * p[2], view.fy * p[1] + view.cy * p[2],
             p[2]} {}
  float axes[3];
};

/// Coordinates of a slab's voxels.
struct SlabRamps {
  constexpr SlabRamps() : y(), z() {
    for (int i = 0; i < kSlab; ++i) {
      y[i] = static_cast<float>(i / kSide);
      z[i] = static_cast<float>(i % kSide);
    }
  }
  float y[kSlab], z[kSlab];
};

/// A slab of a rigid block, pack by pack, counted from its first voxel.
template <typename Pack>
struct RigidSlab {
  static constexpr int kPacks = kSlab / Pack::kCount;

  SPLITFUSION_INLINE RigidSlab(const FusionView& view,
                               const float steps[3][3]) {
    static constexpr SlabRamps kRamps;
    const SeenPoint along_y(view, steps[1]), along_z(view, steps[2]);
    for (int i = 0; i < kPacks; ++i) {
      typename Pack::Real y, z;
      std::memcpy(&y, kRamps.y + i * Pack::kCount, sizeof(y));
      std::memcpy(&z, kRamps.z + i * Pack::kCount, sizeof(z));
      for (int axis = 0; axis < 3; ++axis) {
        offsets[i][axis] = y * along_y.axes[axis] + z * along_z.axes[axis];
      }
      // Along both axes the nearest voxel is at an end.
      const auto end = [](float step, int count) {
        return step < 0 ? static_cast<float>(count) * step : 0.0f;
      };
      lowest[i] = offsets[i][2][0] + end(along_z.axes[2], kSide - 1) +
                  end(along_y.axes[2], Pack::kCount / kSide - 1);
    }
    nearest = lowest[along_y.axes[2] < 0 ? kPacks - 1 : 0];
  }

  typename Pack::Real offsets[kPacks][3];  // As SeenVoxels.
  float lowest[kPacks];                    // Depths are not below.
  float nearest;                           // The least of them.
};

/// FuseRigid() of one block; `kAllInside`: all of its voxels are in the image.
template <typename Pack, bool kAllInside>
SPLITFUSION_INLINE bool FuseRigidBlock(const FusionView& view,
                                       const RigidSlab<Pack>& slab,
                                       const SeenPoint& along_x,
                                       const RigidBlock& block) {
  PrefetchSlab(block.leaf, 0);
  PrefetchSlab(block.leaf, 1);
  const SeenPoint start(view, block.base);
  const float farthest = block.part.farthest;
  SeenSlab<Pack> seen;
  for (auto& foreign : seen.foreign) foreign = typename Pack::Whole{};
  typename Pack::Whole changed = {};
  for (int x = 0; x < kSide; ++x) {
    if (x + 2 < kSide) PrefetchSlab(block.leaf, x + 2);
    float corner[3];
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis] =
          start.axes[axis] + static_cast<float>(x) * along_x.axes[axis];
    }
    if (corner[2] + slab.nearest > farthest) continue;
    for (int i = 0; i < slab.kPacks; ++i) {
      seen.hidden[i] = corner[2] + slab.lowest[i] > farthest;
      if (seen.hidden[i]) continue;
      const SeenVoxels<Pack> at = {corner[0] + slab.offsets[i][0],
                                   corner[1] + slab.offsets[i][1],
                                   corner[2] + slab.offsets[i][2]};
      const auto pixel = PixelsOf<Pack, kAllInside>(view, at);
      std::memcpy(seen.pixel[i], &pixel, sizeof(pixel));
      seen.z[i] = at.z;
    }
    FuseSlab<Pack>(view, seen, VoxelsFrom(block.leaf, x * kSlab), &changed);
  }
  return Pack::Any(Pack::NotZero(changed));
}

/// See FuseRigidBlocks().
template <typename Pack>
SPLITFUSION_INLINE void FuseRigid(const FusionView& view,
                                  const float steps[3][3], RigidBlock* blocks,
                                  int count) {
  const RigidSlab<Pack> slab(view, steps);
  const SeenPoint along_x(view, steps[0]);
  for (int i = 0; i < count; ++i) {
    RigidBlock& block = blocks[i];
    block.changed =
        block.part.in_image
            ? FuseRigidBlock<Pack, true>(view, slab, along_x, block)
            : FuseRigidBlock<Pack, false>(view, slab, along_x, block);
  }
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_
