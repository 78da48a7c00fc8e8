#include "splitfusion/lib/tsdf/internal/padded_leaf.h"

#include "splitfusion/lib/base/floor_to_int.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"

namespace splitfusion {
namespace internal {
namespace {

/// A point of index space between voxels: the lowest of the eight, counted from
/// a block's origin, and how far it is on.
struct Cell {
  Cell(const openvdb::Vec3d& p, const openvdb::Coord& origin) {
    for (int axis = 0; axis < 3; ++axis) {
      const int floor = FloorToInt(p[axis]);
      low[axis] = floor - origin[axis];
      part[axis] = p[axis] - floor;
    }
  }
  int low[3];
  double part[3];
};

/// Between a and b, with OpenVDB's roundings.
float Mix(float a, float b, double weight) {
  return a + static_cast<float>((b - a) * weight);
}

/// Trilinear value; read(i, j, k) is a corner's, i, j, k = 0 or 1.
template <typename Read>
float Trilinear(const Cell& cell, const Read& read) {
  float by_x[2];
  for (int i = 0; i < 2; ++i) {
    by_x[i] =
        Mix(Mix(read(i, 0, 0), read(i, 0, 1), cell.part[2]),
            Mix(read(i, 1, 0), read(i, 1, 1), cell.part[2]), cell.part[1]);
  }
  return Mix(by_x[0], by_x[1], cell.part[0]);
}

}  // namespace

LeafLookup::LeafLookup(const TsdfVolume& volume)
    : grids_(volume.grids()),
      free_space_(kLeafVoxels, grids_.distance->background()),
      unobserved_(kLeafVoxels, 0.0f),
      black_(kLeafVoxels, 0),
      nowhere_{{}, free_space_.data(), unobserved_.data(), black_.data()} {}

bool LeafLookup::MayHaveSurface(const openvdb::Coord& origin) const {
  const auto [x, y, z] = PlaceOf(origin);
  for (int k = 0; k < 8; ++k) {
    const std::int32_t number =
        grids_.table.Find(x + (k >> 2), y + ((k >> 1) & 1), z + (k & 1));
    if (number != 0 && grids_.states[number - 1].has_inside) return true;
  }
  return false;
}

PaddedLeaf::PaddedLeaf(const LeafLookup& lookup, const openvdb::Coord& origin)
    : origin_(origin) {
  for (int i = 0; i < 27; ++i) {
    leaves_[i] = &lookup.Find(origin.offsetBy(kLeafSize * (i / 9 - 1),
                                              kLeafSize * (i / 3 % 3 - 1),
                                              kLeafSize * (i % 3 - 1)));
  }
  CopyRows(
      &LeafBuffers::distance, [](float distance) { return distance; },
      &distance_);
}

template <typename Convert, typename Target>
void PaddedLeaf::CopyRows(float* LeafBuffers::*buffer, const Convert& convert,
                          Target* target) const {
  for (int x = -1; x < kSide - 1; ++x) {
    for (int y = -1; y < kSide - 1; ++y) {
      const int row = (x & 7) << 6 | (y & 7) << 3;
      const LeafBuffers* const* leaves = &leaves_[Neighbor(x, y, -1)];
      const float* here = leaves[1]->*buffer + row;
      const float* after = leaves[2]->*buffer + row;
      auto* to = &(*target)[Index(x, y, -1)];
      to[0] = convert((leaves[0]->*buffer)[row + kLeafSize - 1]);
      for (int z = 0; z < kLeafSize; ++z) to[z + 1] = convert(here[z]);
      to[kLeafSize + 1] = convert(after[0]);
      to[kLeafSize + 2] = convert(after[1]);
    }
  }
}

void PaddedLeaf::LoadObserved(float min_weight) {
  CopyRows(
      &LeafBuffers::weight,
      [&](float weight) -> char { return weight >= min_weight; }, &observed_);
}

std::uint32_t PaddedLeaf::Inside(int x, int y) const {
  const float* row = &distance_[Index(x, y, -1)];
  std::uint32_t bits = 0;
  for (int z = 0; z < kSide; ++z) bits |= (row[z] < 0 ? 1u : 0u) << z;
  return bits;
}

float PaddedLeaf::Distance(const openvdb::Vec3d& p) const {
  const Cell cell(p, origin_);
  const float* low = &distance_[Index(cell.low[0], cell.low[1], cell.low[2])];
  return Trilinear(cell, [&](int i, int j, int k) {
    return low[(i * kSide + j) * kSide + k];
  });
}

bool PaddedLeaf::Observed(const openvdb::Vec3d& p) const {
  const Cell cell(p, origin_);
  const char* low = &observed_[Index(cell.low[0], cell.low[1], cell.low[2])];
  char all = 1;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      const char* row = low + (i * kSide + j) * kSide;
      all &= row[0] & row[1];
    }
  }
  return all != 0;
}

openvdb::Vec3s PaddedLeaf::Color(const openvdb::Vec3d& p) const {
  const Cell cell(p, origin_);
  std::int32_t corners[8];
  for (int corner = 0; corner < 8; ++corner) {
    const int x = cell.low[0] + (corner >> 2);
    const int y = cell.low[1] + ((corner >> 1) & 1);
    const int z = cell.low[2] + (corner & 1);
    const std::int32_t* color = leaves_[Neighbor(x, y, z)]->color;
    corners[corner] =
        color == nullptr ? 0 : color[(x & 7) << 6 | (y & 7) << 3 | (z & 7)];
  }
  openvdb::Vec3s color;
  for (int channel = 0; channel < 3; ++channel) {
    const float mean = Trilinear(cell, [&](int i, int j, int k) {
      return static_cast<float>(
          ChannelOf(corners[i << 2 | j << 1 | k], channel));
    });
    color[channel] = mean / kChannelEnd;
  }
  return color;
}

}  // namespace internal
}  // namespace splitfusion
