#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafVoxels;

/// What there is to know of all blocks beside their voxels.
struct BlockList {
  std::vector<std::array<std::int32_t, 3>> origins;
  std::vector<std::int32_t> changed;
  std::vector<std::uint8_t> has_inside;

  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(origins, changed, has_inside);
  }
};

BlockList ListBlocks(const TsdfVolume::Grids& grids) {
  BlockList list;
  for (const internal::LeafBuffers& leaf : grids.leaves) {
    list.origins.push_back({leaf.origin.x(), leaf.origin.y(), leaf.origin.z()});
  }
  for (const internal::LeafState& state : grids.states) {
    list.changed.push_back(state.changed);
    list.has_inside.push_back(state.has_inside ? 1 : 0);
  }
  return list;
}

/// Makes the blocks in the order in which they came to be; `reader`: to fail.
void MakeBlocks(const BlockList& list, const ArchiveReader& reader,
                TsdfVolume::Grids* grids) {
  const std::size_t count = list.origins.size();
  if (list.changed.size() != count || list.has_inside.size() != count) {
    reader.Fail("lists of blocks of different lengths");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y, z] = list.origins[i];
    grids->Touch({x, y, z});
    if (grids->leaves.size() != i + 1) reader.Fail("one block twice");
    grids->states[i] = {list.changed[i], list.has_inside[i] != 0};
  }
}

/// One block of one grid: whether all voxels are the same, and that one or all.
template <typename Archive, typename T>
void SerializeVoxels(Archive* archive, T* voxels) {
  bool is_uniform = false;
  if constexpr (!Archive::kReads) {
    is_uniform =
        std::memcmp(voxels, voxels + 1, (kLeafVoxels - 1) * sizeof(T)) == 0;
  }
  (*archive)(is_uniform);
  archive->Raw(voxels, (is_uniform ? 1 : kLeafVoxels) * sizeof(T));
  if (Archive::kReads && is_uniform) {
    std::fill_n(voxels + 1, kLeafVoxels - 1, voxels[0]);
  }
}

}  // namespace

template <typename Archive>
void TsdfVolume::Serialize(Archive* archive) {
  archive->Section("volume");
  ExpectSame(archive, "voxel_size", options_.voxel_size);
  ExpectSame(archive, "truncation", options_.truncation);
  ExpectSame(archive, "has_color", options_.has_color);
  if constexpr (Archive::kReads) *this = TsdfVolume(options_);
  Grids& grids = *grids_;
  BlockList list = ListBlocks(grids);
  (*archive)(grids.time, list);
  if constexpr (Archive::kReads) MakeBlocks(list, *archive, &grids);
  for (const internal::LeafBuffers& leaf : grids.leaves) {
    SerializeVoxels(archive, leaf.distance);
    SerializeVoxels(archive, leaf.weight);
    if (options_.has_color) SerializeVoxels(archive, leaf.color);
  }
}

template void TsdfVolume::Serialize(ArchiveWriter*);
template void TsdfVolume::Serialize(ArchiveReader*);

}  // namespace splitfusion
