#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_RIGID_FUSION_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_RIGID_FUSION_H_

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// A version of FuseRigidBlocks(). All give the same numbers.
using RigidFusion = void (*)(const FusionView& view, const float steps[3][3],
                             RigidBlock* blocks, int count);

/// Sixteen voxels at a time; null if this processor, or this build, cannot.
RigidFusion Avx512Fusion();

/// Eight voxels at a time; null if this processor, or this build, cannot.
RigidFusion Avx2Fusion();

/// Eight voxels at a time, for any processor.
RigidFusion PortableFusion();

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_RIGID_FUSION_H_
