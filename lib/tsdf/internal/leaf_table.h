#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_TABLE_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_TABLE_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace splitfusion {
namespace internal {

/// Coordinates of a block of 8x8x8 voxels: those of its voxels divided by 8.
using LeafPlace = std::array<std::int32_t, 3>;

/// Where to find the number of a block quickly: a table of cubes of 16^3 blocks
/// around all that are there. Free of OpenVDB, for loops over many voxels.
class LeafTable {
 public:
  LeafTable();

  /// Enters a block that is not there yet; `number` > 0.
  void Insert(const LeafPlace& place, std::int32_t number);

  /// Number of the block at a place; 0 = no block.
  std::int32_t Find(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return leaves_[cubes_[CubeAt(x, y, z)] + Offset(x, y, z)];
  }

 private:
  static constexpr int kLogSize = 4;
  static constexpr int kMask = (1 << kLogSize) - 1;

  static std::int32_t Offset(std::int32_t x, std::int32_t y, std::int32_t z) {
    return (((x & kMask) << kLogSize | (y & kMask)) << kLogSize) | (z & kMask);
  }
  std::int32_t CubeAt(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (Clamped(x, 0) * size_[1] + Clamped(y, 1)) * size_[2] +
           Clamped(z, 2);
  }
  /// Index of a cube along one axis; the outermost ones are empty.
  std::int32_t Clamped(std::int32_t place, int axis) const {
    return std::clamp((place >> kLogSize) - low_[axis], 0, size_[axis] - 1);
  }

  void GrowTo(const LeafPlace& cube);

  LeafPlace low_ = {0, 0, 0};         // Of the cubes, with an empty border.
  LeafPlace size_ = {2, 2, 2};        // Cubes along the axes: none but that.
  std::vector<std::int32_t> cubes_;   // Where they begin in leaves_.
  std::vector<std::int32_t> leaves_;  // The first cube is empty.
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_TABLE_H_
