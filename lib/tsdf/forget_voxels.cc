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

/// Forgets the voxels of one block; returns whether there was any.
bool ForgetInLeaf(const internal::LeafBuffers& leaf, const TsdfOptions& options,
                  const SkinningIndex& index, const std::vector<char>& nodes) {
  bool any = false;
  for (int i = 0; i < internal::kLeafVoxels; ++i) {
    if (!(leaf.weight[i] > 0)) continue;
    const Eigen::Vector3f place =
        PlaceOfVoxel(leaf.origin, i / 64, i / 8 % 8, i % 8,
                     static_cast<float>(options.voxel_size));
    if (nodes[index.NearestNode(place, nullptr)] == 0) continue;
    leaf.weight[i] = 0;
    leaf.distance[i] = static_cast<float>(options.truncation);
    any = true;
  }
  return any;
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
  const float voxel = static_cast<float>(volume->options().voxel_size);
  const float diagonal = 1.74f * voxel * kLeafSize;  // Maths.
  TsdfVolume::Grids& grids = volume->grids();
  ++grids.time;
  tbb::parallel_for(std::size_t{0}, grids.leaves.size(), [&](std::size_t i) {
    const internal::LeafBuffers& leaf = grids.leaves[i];
    const int middle = kLeafSize / 2;
    const Eigen::Vector3f center =
        PlaceOfVoxel(leaf.origin, middle, middle, middle, voxel);
    float nearest = 0, nearest_forgotten = 0;
    index.NearestNode(center, &nearest);
    forgotten.Find(center, -1, &nearest_forgotten);
    // No voxel of it is nearer to one of them than to another node.
    if (nearest_forgotten > nearest + diagonal ||
        !ForgetInLeaf(leaf, volume->options(), index, nodes)) {
      return;
    }
    grids.RecordChange(i, internal::HasInside(internal::ToFused(leaf)));
  });
}

}  // namespace splitfusion
