#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_PADDED_LEAF_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_PADDED_LEAF_H_

#include <array>
#include <cstdint>
#include <vector>

#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace internal {

/// All blocks of a volume, to be found by their place.
class LeafLookup {
 public:
  /// The volume must not change while this is in use.
  explicit LeafLookup(const TsdfVolume& volume);

  /// Block that holds a voxel; free space that was never
  /// observed if there is none.
  const LeafBuffers& Find(const openvdb::Coord& voxel) const {
    const auto [x, y, z] = PlaceOf(voxel);
    const std::int32_t number = grids_.table.Find(x, y, z);
    return number == 0 ? nowhere_ : grids_.leaves[number - 1];
  }

  /// Whether the surface may pass through the cells of a block, which need not
  /// be there.
  bool MayHaveSurface(const openvdb::Coord& origin) const;

 private:
  const TsdfVolume::Grids& grids_;
  std::vector<float> free_space_, unobserved_;
  std::vector<std::int32_t> black_;
  LeafBuffers nowhere_;
};

/// A block with a border, all that its mesh depends on: voxels -1 to 9 along
/// every axis, counted from the block's origin. Where there is no block the
/// distance is that of free space and the weight 0.
class PaddedLeaf {
 public:
  using ValueType = float;  ///< For OpenVDB's templates.

  /// Reads the distances of the block at `origin`, which need not be there.
  PaddedLeaf(const LeafLookup& lookup, const openvdb::Coord& origin);

  /// Reads what else there is; `min_weight`: an observed voxel's.
  void LoadObserved(float min_weight);

  /// Distance of a voxel counted from the origin, metres.
  float getValue(const openvdb::Coord& at) const {
    return distance_[Index(at.x(), at.y(), at.z())];
  }

  /// Bit z + 1 is set if the distance of voxel (x, y, z) is negative.
  std::uint32_t Inside(int x, int y) const;

  /// Trilinear distance at a point of index space, metres.
  float Distance(const openvdb::Vec3d& p) const;

  /// Whether all eight voxels around a point of index space were observed.
  bool Observed(const openvdb::Vec3d& p) const;

  /// Trilinear colour at a point of index space, 0..1.
  openvdb::Vec3s Color(const openvdb::Vec3d& p) const;

 private:
  static constexpr int kSide = kLeafSize + 3;

  static int Index(int x, int y, int z) {
    return ((x + 1) * kSide + y + 1) * kSide + z + 1;
  }
  /// Which of the 27 blocks holds a voxel.
  static int Neighbor(int x, int y, int z) {
    return 9 * ((x >> 3) + 1) + 3 * ((y >> 3) + 1) + (z >> 3) + 1;
  }
  /// convert(value) of all voxels of one kind of buffer.
  template <typename Convert, typename Target>
  void CopyRows(float* LeafBuffers::*buffer, const Convert& convert,
                Target* target) const;

  openvdb::Coord origin_;
  std::array<const LeafBuffers*, 27> leaves_;
  std::array<float, kSide * kSide * kSide> distance_;
  std::array<char, kSide * kSide * kSide> observed_;
};

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_PADDED_LEAF_H_
