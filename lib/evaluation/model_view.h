#ifndef SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_
#define SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// What the live camera sees of the model.
struct ModelView {
  cv::Mat_<float> depth;  ///< HxW z-depth, metres, 0 = nothing.
  cv::Mat_<int> surface;  ///< HxW id of the surface, -1 = nothing.
};

/// Renders surfaces as they lie in a frame, each of which must have motions for
/// it; triangles seen from behind are left out.
ModelView RenderModelView(const std::vector<const AnimatedSurface*>& surfaces,
                          int frame, const PinholeCamera& camera);

/// Depth of all surfaces of a run as the live camera sees them in a frame:
/// HxW z-depth, metres, 0 = nothing. Surfaces without motions for the frame
/// are left out, triangles seen from behind too.
cv::Mat_<float> RenderModelDepth(const std::vector<AnimatedSurface>& surfaces,
                                 int frame, const PinholeCamera& camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_MODEL_VIEW_H_
