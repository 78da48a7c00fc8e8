#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

namespace splitfusion {
namespace internal {

/// Whether this processor, and this build, can do the following.
bool HasWideLanes();

/// FuseRigidLeaf() sixteen voxels at a time: the same numbers, sooner.
bool FuseRigidWide(const FusionView& view, const float base[3],
                   const float steps[3][3], const FusedPart& part,
                   const FusedLeaf& leaf);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_WIDE_FUSION_H_
