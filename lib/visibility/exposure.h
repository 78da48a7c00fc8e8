#ifndef SPLITFUSION_LIB_VISIBILITY_EXPOSURE_H_
#define SPLITFUSION_LIB_VISIBILITY_EXPOSURE_H_

#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// How much of a surface is in view: its live pixels, of these and of what is
/// hidden of its model by something nearer; 0..1, 1 if nothing hides it. What
/// the image's border cuts off does not count. `model`: its depth if no other
/// surface hid it, at every `step`-th live pixel; metres, 0 = nothing.
double Exposure(const cv::Mat_<float>& model, int step, const LiveView& live,
                int surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_EXPOSURE_H_
