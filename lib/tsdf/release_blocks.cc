#include "splitfusion/lib/tsdf/release_blocks.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafVoxels;
using internal::LeafBuffers;

/// Whether the surface is in a block or in one of those around it.
bool IsNearSurface(const TsdfVolume::Grids& grids, const LeafBuffers& leaf) {
  const auto [x, y, z] = internal::PlaceOf(leaf.origin);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const int number = grids.table.Find(x + dx, y + dy, z + dz);
        if (number > 0 && grids.states[number - 1].has_inside) return true;
      }
    }
  }
  return false;
}

void CopyVoxels(const LeafBuffers& from, const LeafBuffers& to) {
  std::copy_n(from.distance, kLeafVoxels, to.distance);
  std::copy_n(from.weight, kLeafVoxels, to.weight);
  if (from.color != nullptr) std::copy_n(from.color, kLeafVoxels, to.color);
}

}  // namespace

std::size_t ReleaseFreeBlocks(TsdfVolume* volume) {
  const TsdfVolume::Grids& all = volume->grids();
  TsdfVolume kept(volume->options());
  TsdfVolume::Grids& grids = kept.grids();
  grids.time = all.time;
  for (std::size_t n = 0; n < all.leaves.size(); ++n) {
    if (!IsNearSurface(all, all.leaves[n])) continue;
    grids.Touch(all.leaves[n].origin);
    CopyVoxels(all.leaves[n], grids.leaves.back());
    grids.states.back() = all.states[n];
  }
  const std::size_t freed = all.leaves.size() - grids.leaves.size();
  if (freed > 0) *volume = std::move(kept);
  return freed;
}

}  // namespace splitfusion
