#ifndef SPLITFUSION_PIPELINES_EXPOSURE_H_
#define SPLITFUSION_PIPELINES_EXPOSURE_H_

#include "splitfusion/lib/association/live_view.h"
#include "splitfusion/pipelines/model_rendering.h"

namespace splitfusion {

/// How much of a surface is in view: its live pixels, of these and of what is
/// hidden of its model by something nearer; 0..1, 1 if nothing hides it or it
/// is not drawn. What the image's border cuts off does not count. Counted on a
/// coarse grid; `stride` is that of the rendering.
double Exposure(const MeshRendering& rendering, int stride,
                const LiveView& live, int surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_EXPOSURE_H_
