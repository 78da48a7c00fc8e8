#include "splitfusion/lib/tsdf/warped_integration.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

constexpr int kCell = 4;  // Voxels between lattice points.
constexpr int kLattice = kLeafSize / kCell + 1;  // Points along an edge: 3.
using internal::kLatticePoints;                  // kLattice^3.

struct LeafLattice {
  bool attached = false;  // Some node is near enough.
  std::array<Skinning, kLatticePoints> skinning;
};

using WarpedLattice = std::array<Eigen::Vector3f, kLatticePoints>;

Eigen::Vector3f LatticePoint(const openvdb::Coord& origin, float voxel, int x,
                             int y, int z) {
  return voxel * Eigen::Vector3f(static_cast<float>(origin.x() + kCell * x),
                                 static_cast<float>(origin.y() + kCell * y),
                                 static_cast<float>(origin.z() + kCell * z));
}

LeafLattice SkinLeaf(const openvdb::Coord& origin, float voxel, float reach,
                     const SkinningIndex& index) {
  LeafLattice lattice;
  const Eigen::Vector3f center = LatticePoint(origin, voxel, 1, 1, 1);
  const float half_diagonal = 0.87f * voxel * kLeafSize;
  float distance = 0;
  int nearest = index.NearestNode(center, &distance);
  lattice.attached = distance < reach + half_diagonal;
  if (!lattice.attached) return lattice;
  int i = 0;
  for (int x = 0; x < kLattice; ++x) {
    for (int y = 0; y < kLattice; ++y) {
      for (int z = 0; z < kLattice; ++z) {
        lattice.skinning[i++] =
            index.Skin(LatticePoint(origin, voxel, x, y, z), &nearest);
      }
    }
  }
  return lattice;
}

WarpedLattice WarpLeaf(const openvdb::Coord& origin, float voxel,
                       const LeafLattice& lattice, const WarpField& warp) {
  WarpedLattice warped;
  int i = 0;
  for (int x = 0; x < kLattice; ++x) {
    for (int y = 0; y < kLattice; ++y) {
      for (int z = 0; z < kLattice; ++z, ++i) {
        warped[i] = warp.WarpPoint(lattice.skinning[i],
                                   LatticePoint(origin, voxel, x, y, z));
      }
    }
  }
  return warped;
}

bool IntegrateLeaf(const internal::FusionImage& image,
                   const WarpedLattice& warped,
                   const internal::LeafBuffers& leaf) {
  float lattice[kLatticePoints][3];
  for (int i = 0; i < kLatticePoints; ++i) {
    for (int axis = 0; axis < 3; ++axis) lattice[i][axis] = warped[i][axis];
  }
  const internal::FusionView& view = image.view();
  if (!image.MayChange(internal::BoundInImage(view, lattice, kLatticePoints))) {
    return false;
  }
  return internal::FuseWarpedLeaf(view, lattice, internal::ToFused(leaf));
}

}  // namespace

struct WarpedIntegrator::Cache {
  std::unordered_map<openvdb::Coord, LeafLattice> lattices;
};

WarpedIntegrator::WarpedIntegrator() : cache_(std::make_unique<Cache>()) {}
WarpedIntegrator::~WarpedIntegrator() = default;
WarpedIntegrator::WarpedIntegrator(WarpedIntegrator&&) noexcept = default;
WarpedIntegrator& WarpedIntegrator::operator=(WarpedIntegrator&&) noexcept =
    default;

void WarpedIntegrator::InvalidateSkinning() { cache_->lattices.clear(); }

void WarpedIntegrator::Integrate(const DepthObservation& observation,
                                 const SkinningIndex& index,
                                 const WarpField& warp, double reach,
                                 TsdfVolume* volume) {
  const std::vector<internal::LeafBuffers> leaves =
      internal::CollectLeaves(volume);
  const internal::FusionImage image(observation, volume->options());
  const float voxel = static_cast<float>(volume->options().voxel_size);
  std::vector<LeafLattice*> lattices;
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto [entry, is_new] = cache_->lattices.try_emplace(leaves[i].origin);
    lattices.push_back(&entry->second);
    if (is_new) missing.push_back(i);
  }
  tbb::parallel_for(std::size_t{0}, missing.size(), [&](std::size_t m) {
    const std::size_t i = missing[m];
    *lattices[i] =
        SkinLeaf(leaves[i].origin, voxel, static_cast<float>(reach), index);
  });
  std::vector<char> changed(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    if (!lattices[i]->attached) return;
    changed[i] = IntegrateLeaf(
        image, WarpLeaf(leaves[i].origin, voxel, *lattices[i], warp),
        leaves[i]);
  });
  internal::RecordChanges(leaves, changed, volume);
}

}  // namespace splitfusion
