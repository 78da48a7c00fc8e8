#ifndef SPLITFUSION_LIB_TSDF_WARPED_INTEGRATION_H_
#define SPLITFUSION_LIB_TSDF_WARPED_INTEGRATION_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/deformation/skinning_change.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Fuses depth into the volume of a non-rigid surface (SplitFusion IV-D): voxel
/// centres are warped into the camera frame first, then updated as in the
/// rigid case.
///
/// Within a block the warp is evaluated by Eq. 2 on a lattice of every fourth
/// voxel and interpolated trilinearly in between: over 4 voxels (2 cm) the
/// blend of neighbouring nodes is linear up to a fraction of a millimetre. The
/// lattice's skinning is kept between frames and made anew where the graph has
/// changed.
class WarpedIntegrator {
 public:
  WarpedIntegrator();
  ~WarpedIntegrator();
  /// Takes the skinning over.
  WarpedIntegrator(WarpedIntegrator&&) noexcept;
  /// Takes the skinning over.
  WarpedIntegrator& operator=(WarpedIntegrator&&) noexcept;

  /// To be called when the graph has changed: renews the skinning that `change`
  /// does not keep. `index`: the one after it.
  void FollowGraph(const SkinningIndex& index, const SkinningChange& change,
                   const TsdfVolume& volume);

  /// Fuses one observation. Blocks farther than `reach` (metres) from every
  /// node are left alone, and those around nodes that are `refuted` (of every
  /// node whether it is; empty: none): where the warp is wrong an observation
  /// tells nothing of the shape.
  ///
  /// @throw InputError if an image is missing or not of the camera's size.
  void Integrate(const DepthObservation& observation,
                 const SkinningIndex& index, const WarpField& warp,
                 double reach, TsdfVolume* volume,
                 const std::vector<char>& refuted = {});

 private:
  struct Cache;
  std::unique_ptr<Cache> cache_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_WARPED_INTEGRATION_H_
