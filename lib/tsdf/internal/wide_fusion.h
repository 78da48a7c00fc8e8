#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// Whether this processor, and this build, can do the following.
bool HasWideLanes();

/// FuseRigidBlocks() sixteen voxels at a time: the same numbers, sooner.
void FuseRigidWide(const FusionView& view, const float steps[3][3],
                   RigidBlock* blocks, int count);

/// The same eight voxels at a time, on any processor.
void FuseRigidNarrow(const FusionView& view, const float steps[3][3],
                     RigidBlock* blocks, int count);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_
