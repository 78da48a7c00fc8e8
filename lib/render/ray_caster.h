#ifndef SPLITFUSION_LIB_RENDER_RAY_CASTER_H_
#define SPLITFUSION_LIB_RENDER_RAY_CASTER_H_

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/render/model_map.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// How a volume is ray-cast.
struct RayCastOptions {
  double min_depth = 0.2;    ///< Metres along the optical axis.
  double max_depth = 6.0;    ///< Metres along the optical axis.
  double min_weight = 0.01;  ///< Voxels observed less are not surface.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// Per-pixel ray casting of the zero level of a rigid surface (SplitFusion
/// IV-D): rays skip empty space block by block, walk the voxels of a block and
/// refine the first crossing from front to back by trilinear interpolation.
/// Normals are the gradient of the distance.
ModelMap RayCast(const TsdfVolume& volume, const Rigid3d& camera_from_canonical,
                 const PinholeCamera& camera, const RayCastOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_RAY_CASTER_H_
