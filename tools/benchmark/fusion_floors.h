#ifndef SPLITFUSION_TOOLS_BENCHMARK_FUSION_FLOORS_H_
#define SPLITFUSION_TOOLS_BENCHMARK_FUSION_FLOORS_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {

/// Blocks of which an integration changes at least one distance or weight:
/// `integrate` is run once on the volume.
std::vector<internal::LeafBuffers> TouchedLeaves(
    TsdfVolume* volume, const std::function<void()>& integrate);

/// Reads and writes distance and weight of every voxel once, in parallel, with
/// one addition each. Returns the number of voxels.
std::size_t StreamVoxels(const std::vector<internal::LeafBuffers>& leaves);

/// Projective fusion as one first writes it, in parallel: distance and weight
/// of every voxel, each pixel counting as 1, nothing passed over, no carving of
/// other surfaces' space. Returns the number of voxels.
std::size_t FusePlainly(const std::vector<internal::LeafBuffers>& leaves,
                        const DepthObservation& observation,
                        const Rigid3d& camera_from_canonical,
                        const TsdfOptions& options);

/// Reads distance and weight of every voxel once, in parallel; their sum.
float SumVoxels(const std::vector<internal::LeafBuffers>& leaves);

/// StreamVoxels(), and adds to every distance a place that is blended from
/// `nodes` (affine maps, row by row 3x4) at every fourth voxel and interpolated
/// in between: the barest skinning. `first` has one node index a block; the
/// block is carried by it and the `kCarriers` - 1 that follow.
std::size_t SkinVoxels(const std::vector<internal::LeafBuffers>& leaves,
                       const std::vector<float>& nodes,
                       const std::vector<int>& first);
constexpr int kCarriers = 6;  ///< Nodes that carry a point.

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_FUSION_FLOORS_H_
