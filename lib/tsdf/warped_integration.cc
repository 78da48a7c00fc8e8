#include "splitfusion/lib/tsdf/warped_integration.h"

#include <tbb/parallel_for.h>

#include <array>
#include <deque>
#include <utility>
#include <vector>

#include "splitfusion/lib/tsdf/check_observation.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

constexpr int kCell = 4;  // Voxels between lattice points.
constexpr int kLattice = kLeafSize / kCell + 1;  // Points along an edge: 3.
using internal::kLatticePoints;                  // kLattice^3.

/// Lattice points are counted z fastest. A block owns the eight that are not on
/// its upper faces; the others are its neighbours'.
constexpr int kOwnPoints = 8;  // Layout.
struct LatticeIndex {
  explicit LatticeIndex(int i) : x(i / 9), y(i / 3 % 3), z(i % 3) {}
  /// Which neighbour owns the point: 4 dx + 2 dy + dz, d = 1 if it is the next
  /// one along the axis. 0: the block itself.
  int owner() const { return (x / 2) * 4 + (y / 2) * 2 + z / 2; }
  /// Number of the point among those of its owner.
  int own() const { return (x % 2) * 4 + (y % 2) * 2 + z % 2; }
  int x, y, z;
};

struct SkinnedPoint {
  int lattice_index = 0;
  Skinning skinning;
  SkinningSupport support;
};

/// Skinning of a block's lattice.
struct LeafLattice {
  bool skinned = false;
  bool attached = false;  // Some node is near enough.
  std::array<SkinnedPoint, kOwnPoints> own;
  /// Points whose owner is not there or not attached.
  std::vector<SkinnedPoint> border;
  /// Bit LatticeIndex::owner(): its points are not in `border`.
  unsigned owned = 0xff;
};

/// A block and those that own its lattice, see LatticeIndex::owner(); -1: not
/// there or not attached.
using Owners = std::array<int, 8>;
using OwnPoints = std::array<Eigen::Vector3f, kOwnPoints>;
using WarpedLattice = std::array<Eigen::Vector3f, kLatticePoints>;

Eigen::Vector3f LatticePoint(const openvdb::Coord& origin, float voxel,
                             const LatticeIndex& at) {
  return voxel * Eigen::Vector3f(static_cast<float>(origin.x() + kCell * at.x),
                                 static_cast<float>(origin.y() + kCell * at.y),
                                 static_cast<float>(origin.z() + kCell * at.z));
}

/// Skins a point of a block; `support`: of the point before.
SkinnedPoint SkinPoint(const openvdb::Coord& origin, float voxel,
                       const SkinningIndex& index, int lattice_index,
                       SkinningSupport* support) {
  SkinnedPoint point;
  point.lattice_index = lattice_index;
  point.skinning = index.Skin(
      LatticePoint(origin, voxel, LatticeIndex(lattice_index)), support);
  point.support = *support;
  return point;
}

/// The middle of a block, which is a point of its own.
constexpr int kCenter = kLatticePoints / 2;

/// The node nearest to the middle of an attached block.
int MiddleNode(const LeafLattice& lattice) {
  return lattice.own[LatticeIndex(kCenter).own()].support.nearest;
}

/// Skins the points that a block owns.
void SkinOwn(const openvdb::Coord& origin, float voxel, float reach,
             const SkinningIndex& index, LeafLattice* lattice) {
  const LatticeIndex center(kCenter);
  const float half_diagonal = 0.87f * voxel * kLeafSize;  // Maths.
  float distance = 0;
  SkinningSupport support;
  support.nearest =
      index.NearestNode(LatticePoint(origin, voxel, center), &distance);
  lattice->skinned = true;
  lattice->attached = distance < reach + half_diagonal;
  if (!lattice->attached) return;
  for (int i = 0; i < kLatticePoints; ++i) {
    const LatticeIndex at(i);
    if (at.owner() != 0) continue;
    lattice->own[at.own()] = SkinPoint(origin, voxel, index, i, &support);
  }
}

/// Skins the points of a block that have no owner, where some have lost theirs.
void SkinBorder(const openvdb::Coord& origin, float voxel, const Owners& owners,
                const SkinningIndex& index, LeafLattice* lattice) {
  unsigned owned = 0;
  for (int k = 0; k < 8; ++k) owned |= (owners[k] >= 0 ? 1u : 0u) << k;
  if (!lattice->attached || (lattice->owned & ~owned) == 0) return;
  lattice->owned = owned;
  lattice->border.clear();
  SkinningSupport support;
  for (int i = 0; i < kLatticePoints; ++i) {
    if (owners[LatticeIndex(i).owner()] >= 0) continue;
    lattice->border.push_back(SkinPoint(origin, voxel, index, i, &support));
  }
}

/// Skins those points again that a change of the graph does not keep.
template <typename Points>
void FollowPoints(const openvdb::Coord& origin, float voxel,
                  const SkinningIndex& index, const SkinningChange& change,
                  Points* points) {
  SkinningSupport support;
  for (SkinnedPoint& point : *points) {
    if (change.Keeps(point.support)) {
      change.Renumber(&point.skinning, &point.support);
      continue;
    }
    point = SkinPoint(origin, voxel, index, point.lattice_index, &support);
  }
}

/// Warps the points that a block owns.
OwnPoints WarpOwn(const openvdb::Coord& origin, float voxel,
                  const LeafLattice& lattice, const WarpField& warp) {
  OwnPoints warped;
  for (int i = 0; i < kLatticePoints && lattice.attached; ++i) {
    const LatticeIndex at(i);
    if (at.owner() != 0) continue;
    warped[at.own()] = warp.WarpPoint(lattice.own[at.own()].skinning,
                                      LatticePoint(origin, voxel, at));
  }
  return warped;
}

/// All points of a block, given those that blocks own.
WarpedLattice GatherLattice(const openvdb::Coord& origin, float voxel,
                            const Owners& owners,
                            const std::vector<OwnPoints>& own,
                            const LeafLattice& lattice, const WarpField& warp) {
  WarpedLattice warped;
  for (int i = 0; i < kLatticePoints; ++i) {
    const LatticeIndex at(i);
    const int owner = owners[at.owner()];
    if (owner >= 0) warped[i] = own[owner][at.own()];
  }
  for (const SkinnedPoint& point : lattice.border) {
    warped[point.lattice_index] = warp.WarpPoint(
        point.skinning,
        LatticePoint(origin, voxel, LatticeIndex(point.lattice_index)));
  }
  return warped;
}

/// Middle of a cell of the lattice, given its lowest point.
Eigen::Vector3f CellCenter(const WarpedLattice& warped, int lowest) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const int x : {0, 9}) {
    for (const int y : {0, 3}) {
      for (const int z : {0, 1}) sum += warped[lowest + x + y + z];
    }
  }
  return sum / 8;
}

/// Marks the cells of a block whose pixels belong elsewhere.
void MarkForeign(const DepthObservation& observation, float voxel,
                 const openvdb::Coord& origin, const WarpedLattice& warped,
                 bool foreign[internal::kLatticeCells]) {
  const float tolerance = static_cast<float>(observation.place_tolerance);
  const Eigen::Vector3f half_cell =
      Eigen::Vector3f::Constant(0.5f * kCell * voxel);
  for (int i = 0; i < internal::kLatticeCells; ++i) {
    const int lowest = 9 * (i >> 2) + 3 * ((i >> 1) & 1) + (i & 1);
    const Eigen::Vector3f center = CellCenter(warped, lowest);
    foreign[i] = false;
    const auto pixel = observation.camera.PixelOf(center);
    if (!pixel) continue;
    const cv::Vec3f& at = observation.places(pixel->y(), pixel->x());
    const Eigen::Vector3f apart =
        LatticePoint(origin, voxel, LatticeIndex(lowest)) + half_cell -
        Eigen::Vector3f(at[0], at[1], at[2]);
    foreign[i] = apart.squaredNorm() > tolerance * tolerance;
  }
}

bool IntegrateLeaf(const DepthObservation& observation,
                   const internal::FusionImage& image, float voxel,
                   const WarpedLattice& warped,
                   const internal::LeafBuffers& leaf) {
  float lattice[kLatticePoints][3];
  Eigen::AlignedBox3f box;
  for (int i = 0; i < kLatticePoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) lattice[i][axis] = warped[i][axis];
    box.extend(warped[i]);
  }
  if (box.min().z() >= image.Farthest(box)) return false;
  bool foreign[internal::kLatticeCells] = {};
  if (!observation.places.empty()) {
    MarkForeign(observation, voxel, leaf.origin, warped, foreign);
  }
  return internal::FuseWarpedLeaf(image.view(), lattice, foreign,
                                  internal::ToFused(leaf));
}

/// The attached blocks that own the lattice of every block.
std::vector<Owners> FindOwners(const TsdfVolume::Grids& grids,
                               const std::deque<LeafLattice>& lattices) {
  std::vector<Owners> owners(grids.leaves.size());
  tbb::parallel_for(std::size_t{0}, owners.size(), [&](std::size_t i) {
    const auto [x, y, z] = internal::PlaceOf(grids.leaves[i].origin);
    for (int k = 0; k < 8; ++k) {
      const int owner =
          grids.table.Find(x + (k >> 2), y + ((k >> 1) & 1), z + (k & 1)) - 1;
      owners[i][k] = owner >= 0 && lattices[owner].attached ? owner : -1;
    }
  });
  return owners;
}

}  // namespace

struct WarpedIntegrator::Cache {
  std::deque<LeafLattice> lattices;  // Of the volume's blocks.
};

WarpedIntegrator::WarpedIntegrator() : cache_(std::make_unique<Cache>()) {}
WarpedIntegrator::~WarpedIntegrator() = default;
WarpedIntegrator::WarpedIntegrator(WarpedIntegrator&&) noexcept = default;
WarpedIntegrator& WarpedIntegrator::operator=(WarpedIntegrator&&) noexcept =
    default;

void WarpedIntegrator::FollowGraph(const SkinningIndex& index,
                                   const SkinningChange& change,
                                   const TsdfVolume& volume) {
  const float voxel = static_cast<float>(volume.options().voxel_size);
  const std::vector<internal::LeafBuffers>& leaves = volume.grids().leaves;
  std::deque<LeafLattice>& lattices = cache_->lattices;
  tbb::parallel_for(std::size_t{0}, lattices.size(), [&](std::size_t i) {
    LeafLattice& lattice = lattices[i];
    if (lattice.attached && change.KeepsNode(MiddleNode(lattice))) {
      FollowPoints(leaves[i].origin, voxel, index, change, &lattice.own);
      FollowPoints(leaves[i].origin, voxel, index, change, &lattice.border);
    } else {
      lattice =
          LeafLattice();  // A new node may be near enough, or none any more.
    }
  });
}

void WarpedIntegrator::Integrate(const DepthObservation& observation,
                                 const SkinningIndex& index,
                                 const WarpField& warp, double reach,
                                 TsdfVolume* volume,
                                 const std::vector<char>& refuted) {
  CheckObservation(observation, volume->options());
  TsdfVolume::Grids& grids = volume->grids();
  const std::vector<internal::LeafBuffers>& leaves = grids.leaves;
  ++grids.time;
  const internal::FusionImage image(observation, volume->options(), grids.time);
  const float voxel = static_cast<float>(volume->options().voxel_size);
  std::deque<LeafLattice>& lattices = cache_->lattices;
  lattices.resize(leaves.size());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (!lattices[i].skinned) missing.push_back(i);
  }
  tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t m) {
    const std::size_t i = missing[m];
    SkinOwn(leaves[i].origin, voxel, static_cast<float>(reach), index,
            &lattices[i]);
  });
  const std::vector<Owners> owners = FindOwners(grids, lattices);
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    SkinBorder(leaves[i].origin, voxel, owners[i], index, &lattices[i]);
  });
  std::vector<OwnPoints> own(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    own[i] = WarpOwn(leaves[i].origin, voxel, lattices[i], warp);
  });
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    if (!lattices[i].attached ||
        (!refuted.empty() && refuted[MiddleNode(lattices[i])] != 0)) {
      return;
    }
    const WarpedLattice warped = GatherLattice(
        leaves[i].origin, voxel, owners[i], own, lattices[i], warp);
    if (IntegrateLeaf(observation, image, voxel, warped, leaves[i])) {
      grids.RecordChange(i, internal::HasInside(internal::ToFused(leaves[i])));
    }
  });
}

}  // namespace splitfusion
