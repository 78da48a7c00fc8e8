#include "splitfusion/lib/tsdf/forget_voxels.h"

#include <tbb/parallel_for.h>

#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

Eigen::Vector3f PlaceOfVoxel(const openvdb::Coord& origin, int x, int y, int z,
                             float voxel) {
  return voxel * Eigen::Vector3f(static_cast<float>(origin.x() + x),
                                 static_cast<float>(origin.y() + y),
                                 static_cast<float>(origin.z() + z));
}

Eigen::Vector3f MiddleOf(const openvdb::Coord& origin, float voxel) {
  const int middle = kLeafSize / 2;
  return PlaceOfVoxel(origin, middle, middle, middle, voxel);
}

/// No two voxels of a block are farther apart, metres.
float Diagonal(float voxel) {
  return 1.74f * voxel * kLeafSize;  // Maths.
}

/// Forgets those voxels of the blocks for whose middle `near` holds for whose
/// own place `forgotten` does.
template <typename Near, typename Forgotten>
void ForgetWhere(const Near& near, const Forgotten& forgotten,
                 TsdfVolume* volume) {
  const auto voxel = static_cast<float>(volume->options().voxel_size);
  const auto truncation = static_cast<float>(volume->options().truncation);
  TsdfVolume::Grids& grids = volume->grids();
  ++grids.time;
  tbb::parallel_for(std::size_t{0}, grids.leaves.size(), [&](std::size_t n) {
    const internal::LeafBuffers& leaf = grids.leaves[n];
    if (!near(MiddleOf(leaf.origin, voxel))) return;
    bool any = false;
    for (int i = 0; i < internal::kLeafVoxels; ++i) {
      if (!(leaf.weight[i] > 0) ||
          !forgotten(
              PlaceOfVoxel(leaf.origin, i / 64, i / 8 % 8, i % 8, voxel))) {
        continue;
      }
      leaf.weight[i] = 0;
      leaf.distance[i] = truncation;
      any = true;
    }
    if (any)
      grids.RecordChange(n, internal::HasInside(internal::ToFused(leaf)));
  });
}

}  // namespace

void ForgetVoxels(const DeformationGraph& graph, const SkinningIndex& index,
                  const std::vector<char>& nodes, TsdfVolume* volume) {
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < graph.size(); ++i) {
    if (nodes[i] != 0) places.push_back(graph.positions[i].cast<float>());
  }
  if (places.empty()) return;
  const NearestPoint forgotten(places);
  const float diagonal =
      Diagonal(static_cast<float>(volume->options().voxel_size));
  ForgetWhere(
      [&](const Eigen::Vector3f& middle) {
        float nearest = 0, nearest_forgotten = 0;
        index.NearestNode(middle, &nearest);
        forgotten.Find(middle, -1, &nearest_forgotten);
        // Else no voxel of it is nearer to one of them than to another node.
        return nearest_forgotten <= nearest + diagonal;
      },
      [&](const Eigen::Vector3f& place) {
        return nodes[index.NearestNode(place, nullptr)] != 0;
      },
      volume);
}

void ForgetAround(const std::vector<Eigen::Vector3f>& places, double radius,
                  TsdfVolume* volume) {
  if (places.empty()) return;
  const NearestPoint forgotten(places);
  const auto reach = static_cast<float>(radius);
  const float diagonal =
      Diagonal(static_cast<float>(volume->options().voxel_size));
  const auto within = [&](const Eigen::Vector3f& place, float distance) {
    float nearest = 0;
    forgotten.Find(place, -1, &nearest);
    return nearest <= distance;
  };
  ForgetWhere(
      [&](const Eigen::Vector3f& middle) {
        return within(middle, reach + diagonal / 2);
      },
      [&](const Eigen::Vector3f& place) { return within(place, reach); },
      volume);
}

}  // namespace splitfusion
