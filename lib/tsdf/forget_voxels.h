#ifndef SPLITFUSION_LIB_TSDF_FORGET_VOXELS_H_
#define SPLITFUSION_LIB_TSDF_FORGET_VOXELS_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Makes the voxels whose nearest node is one of `nodes` (of every node whether
/// it is) as if they had never been observed. `index`: of the graph.
void ForgetVoxels(const DeformationGraph& graph, const SkinningIndex& index,
                  const std::vector<char>& nodes, TsdfVolume* volume);

/// The same for those within `radius` (metres) of one of these places of the
/// canonical frame (metres).
void ForgetAround(const std::vector<Eigen::Vector3f>& places, double radius,
                  TsdfVolume* volume);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_FORGET_VOXELS_H_
