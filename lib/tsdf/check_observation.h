#ifndef SPLITFUSION_LIB_TSDF_CHECK_OBSERVATION_H_
#define SPLITFUSION_LIB_TSDF_CHECK_OBSERVATION_H_

#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Checks that an observation has all images that a volume with these options
/// needs, and that they have the camera's size.
///
/// @throw InputError that names the image, its size and what was expected.
void CheckObservation(const DepthObservation& observation,
                      const TsdfOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_CHECK_OBSERVATION_H_
