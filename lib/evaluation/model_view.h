#ifndef SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_
#define SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// Depth of all surfaces of a run as the live camera sees them in a frame:
/// HxW z-depth, metres, 0 = nothing. Surfaces without motions for the frame
/// are left out, triangles seen from behind too.
cv::Mat_<float> RenderModelDepth(const std::vector<AnimatedSurface>& surfaces,
                                 int frame, const PinholeCamera& camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_
