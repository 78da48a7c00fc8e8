#ifndef SPLITFUSION_LIB_MODEL_OBSERVE_SURFACE_H_
#define SPLITFUSION_LIB_MODEL_OBSERVE_SURFACE_H_

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// What every live pixel may do to the volume of `surface`: its own write,
/// those of others carve, and those next to depth edges or of no certain
/// surface do nothing. Shares the images of `live`.
DepthObservation ObserveSurface(const LiveView& live, int surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_OBSERVE_SURFACE_H_
