#include "splitfusion/lib/tsdf/internal/leaf_table.h"

#include <utility>

namespace splitfusion {
namespace internal {

LeafTable::LeafTable() : cubes_(8, 0), leaves_(1 << (3 * kLogSize), 0) {}

void LeafTable::Insert(const LeafPlace& place, std::int32_t number) {
  const auto [x, y, z] = place;
  GrowTo({x >> kLogSize, y >> kLogSize, z >> kLogSize});
  std::int32_t& cube = cubes_[CubeAt(x, y, z)];
  if (cube == 0) {
    cube = static_cast<std::int32_t>(leaves_.size());
    leaves_.resize(leaves_.size() + (1 << (3 * kLogSize)), 0);
  }
  leaves_[cube + Offset(x, y, z)] = number;
}

/// Makes room for a cube inside of the border.
void LeafTable::GrowTo(const LeafPlace& cube) {
  LeafPlace low = low_, size = size_;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t end = low_[axis] + size_[axis];  // Behind the border.
    const bool is_empty = size_[axis] == 2;
    low[axis] =
        is_empty ? cube[axis] - 1 : std::min(low_[axis], cube[axis] - 1);
    size[axis] =
        (is_empty ? cube[axis] + 2 : std::max(end, cube[axis] + 2)) - low[axis];
  }
  if (low == low_ && size == size_) return;
  std::vector<std::int32_t> cubes(
      static_cast<std::size_t>(size[0]) * size[1] * size[2], 0);
  for (std::int32_t x = 1; x + 1 < size_[0]; ++x) {
    for (std::int32_t y = 1; y + 1 < size_[1]; ++y) {
      for (std::int32_t z = 1; z + 1 < size_[2]; ++z) {
        cubes[((x + low_[0] - low[0]) * size[1] + y + low_[1] - low[1]) *
                  size[2] +
              z + low_[2] - low[2]] = cubes_[(x * size_[1] + y) * size_[2] + z];
      }
    }
  }
  low_ = low, size_ = size;
  cubes_ = std::move(cubes);
}

}  // namespace internal
}  // namespace splitfusion
