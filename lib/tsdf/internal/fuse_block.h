#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_

#include <algorithm>
#include <cstdint>
#include <cstring>

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

/// Caches that voxels are brought to, as __builtin_prefetch() calls them.
enum class Cache {
  kSecond = 2,  ///< Larger: for voxels of the next block.
  kFirst = 3,   ///< For those that come at once.
};

/// Asks the memory for the voxels that share a line of the cache with the
/// first.
template <Cache kCache>
SPLITFUSION_INLINE void Prefetch(const FusedLeaf& from) {
  constexpr int kLocality = static_cast<int>(kCache);
  __builtin_prefetch(from.distance, 1, kLocality);
  __builtin_prefetch(from.weight, 1, kLocality);
  if (from.color != nullptr) __builtin_prefetch(from.color, 1, kLocality);
}

/// Whether a pack is the first of as many voxels as share a line of the cache,
/// if the block begins one.
template <typename Pack>
constexpr bool BeginsLine(int pack) {
  constexpr int kLine = 64 / sizeof(float);
  return pack * Pack::kCount % kLine == 0;
}

/// Voxels of some slabs as the camera sees them, pack by pack.
template <typename Pack>
struct SeenSlabs {
  static constexpr int kPacks = 8;  ///< Worked on at once.
  static constexpr int kSlabs = kPacks * Pack::kCount / kSlab;
  static_assert(kSlabs * kSlab == kPacks * Pack::kCount);

  std::int32_t pixel[kPacks][Pack::kCount];
  typename Pack::Real z[kPacks];  ///< Metres.
  /// With a minus: only carved. Not set without kForeign.
  typename Pack::Whole foreign[kPacks];
};

/// Asks the memory for as many voxels, from the first on.
template <Cache kCache, typename Pack>
SPLITFUSION_INLINE void PrefetchSlabs(const FusedLeaf& from) {
  for (int i = 0; i < SeenSlabs<Pack>::kPacks; ++i) {
    if (BeginsLine<Pack>(i)) {
      Prefetch<kCache>(VoxelsFrom(from, i * Pack::kCount));
    }
  }
}

/// Fuses what has been looked up; `kAsksChanges`: see FuseRow().
template <typename Pack, bool kAsksChanges>
SPLITFUSION_INLINE void FuseRows(const FusionView& view,
                                 const SeenSlabs<Pack>& slabs,
                                 const SeenRow<Pack>* rows,
                                 const FusedLeaf& leaf,
                                 typename Pack::Whole* changed) {
  for (int i = 0; i < slabs.kPacks; ++i) {
    if (!Pack::Any(rows[i].changes)) continue;
    FuseRow<Pack, kAsksChanges>(view, slabs.pixel[i], slabs.z[i], rows[i],
                                VoxelsFrom(leaf, i * Pack::kCount), changed);
  }
}

/// Fuses into slabs side by side, from `leaf` on; `next`: what is asked of the
/// memory meanwhile, as many voxels. All packs are looked up before the first
/// is written: one after the other each would wait for its pixels and
/// quotients. Once `changed` has a bit, further changes are not looked for.
/// `kForeign`: see SeeRow().
template <typename Pack, bool kForeign>
SPLITFUSION_INLINE void FuseSlabs(const FusionView& view,
                                  const SeenSlabs<Pack>& slabs,
                                  const FusedLeaf& leaf, const FusedLeaf& next,
                                  typename Pack::Whole* changed) {
  SeenRow<Pack> rows[slabs.kPacks];
  for (int i = 0; i < slabs.kPacks; ++i) {
    if (BeginsLine<Pack>(i)) {
      Prefetch<Cache::kFirst>(VoxelsFrom(next, i * Pack::kCount));
    }
    SeeRow<Pack, kForeign>(view, slabs.pixel[i], slabs.z[i], slabs.foreign[i],
                           &rows[i]);
  }
  if (Pack::Any(Pack::NotZero(*changed))) {
    FuseRows<Pack, false>(view, slabs, rows, leaf, changed);
  } else {
    FuseRows<Pack, true>(view, slabs, rows, leaf, changed);
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
    }
    // Along both axes the nearest voxel is at an end.
    constexpr float kEnd = kSide - 1;
    nearest = std::min(kEnd * along_y.axes[2], 0.0f) +
              std::min(kEnd * along_z.axes[2], 0.0f);
  }

  typename Pack::Real offsets[kPacks][3];  // As SeenVoxels.
  float nearest;                           // Depths are not below.
};

/// FuseRigid() of one block; `kAllInside`: all of its voxels are in the image.
/// `next`: the next block's voxels, or again its own, which the memory needs
/// more time for than a few slabs take.
template <typename Pack, bool kAllInside>
SPLITFUSION_INLINE bool FuseRigidBlock(const FusionView& view,
                                       const RigidSlab<Pack>& slab,
                                       const SeenPoint& along_x,
                                       const RigidBlock& block,
                                       const FusedLeaf& next) {
  using Seen = SeenSlabs<Pack>;
  constexpr int kSlabs = Seen::kSlabs;
  PrefetchSlabs<Cache::kFirst, Pack>(block.leaf);
  const SeenPoint start(view, block.base);
  Seen seen;
  typename Pack::Whole changed = {};
  for (int x = 0; x < kSide; x += kSlabs) {
    PrefetchSlabs<Cache::kSecond, Pack>(VoxelsFrom(next, x * kSlab));
    const float z_begin =
        start.axes[2] + static_cast<float>(x) * along_x.axes[2];
    const float z_end =
        start.axes[2] + static_cast<float>(x + kSlabs - 1) * along_x.axes[2];
    if (std::min(z_begin, z_end) + slab.nearest > block.part.farthest) continue;
    for (int pack = 0; pack < Seen::kPacks; ++pack) {
      const float along = static_cast<float>(x + pack / slab.kPacks);
      const auto& offset = slab.offsets[pack % slab.kPacks];
      SeenVoxels<Pack> at;
      at.zu = start.axes[0] + along * along_x.axes[0] + offset[0];
      at.zv = start.axes[1] + along * along_x.axes[1] + offset[1];
      at.z = start.axes[2] + along * along_x.axes[2] + offset[2];
      const auto pixel = PixelsOf<Pack, kAllInside>(view, at);
      std::memcpy(seen.pixel[pack], &pixel, sizeof(pixel));
      seen.z[pack] = at.z;
    }
    const int soon = std::min(x + kSlabs, kSide - kSlabs);
    FuseSlabs<Pack, false>(view, seen, VoxelsFrom(block.leaf, x * kSlab),
                           VoxelsFrom(block.leaf, soon * kSlab), &changed);
  }
  return Pack::Any(Pack::NotZero(changed));
}

/// See HasInside().
template <typename Pack>
SPLITFUSION_INLINE bool HasInsideBy(const FusedLeaf& leaf) {
  using Real = typename Pack::Real;
  for (int x = 0; x < kSide; ++x) {
    bool is_inside = false;
    for (int i = x * kSlab; i < (x + 1) * kSlab; i += Pack::kCount) {
      Real distance, weight;
      std::memcpy(&distance, leaf.distance + i, sizeof(distance));
      std::memcpy(&weight, leaf.weight + i, sizeof(weight));
      is_inside |=
          Pack::Any(~Pack::Less(Real{}, distance) & Pack::Less(Real{}, weight));
    }
    if (is_inside) return true;
  }
  return false;
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
    const FusedLeaf& next = blocks[std::min(i + 1, count - 1)].leaf;
    block.changed =
        block.part.in_image
            ? FuseRigidBlock<Pack, true>(view, slab, along_x, block, next)
            : FuseRigidBlock<Pack, false>(view, slab, along_x, block, next);
    // Asked while the block is in the cache.
    block.has_inside = block.changed && HasInsideBy<Pack>(block.leaf);
  }
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_FUSE_BLOCK_H_
