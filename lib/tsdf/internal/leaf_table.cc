#include "splitfusion/lib/tsdf/internal/leaf_table.h"

namespace splitfusion {
namespace internal {

LeafTable::LeafTable(const std::vector<LeafPlace>& places) {
  constexpr std::int32_t kCubeLeaves = 1 << (3 * kLogSize);
  for (int axis = 0; axis < 3; ++axis) {
    std::int32_t low = 0, high = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int32_t cube = places[i][axis] >> kLogSize;
      low = i == 0 ? cube : std::min(low, cube);
      high = i == 0 ? cube : std::max(high, cube);
    }
    low_[axis] = low - 1;
    size_[axis] = high - low + 3;
  }
  cubes_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], 0);
  leaves_.assign(kCubeLeaves, 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [x, y, z] = places[i];
    std::int32_t& cube =
        cubes_[(Clamped(x, 0) * size_[1] + Clamped(y, 1)) * size_[2] +
               Clamped(z, 2)];
    if (cube == 0) {
      cube = static_cast<std::int32_t>(leaves_.size());
      leaves_.resize(leaves_.size() + kCubeLeaves, 0);
    }
    leaves_[cube + Offset(x, y, z)] = static_cast<std::int32_t>(i) + 1;
  }
}

}  // namespace internal
}  // namespace splitfusion
