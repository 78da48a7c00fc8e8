#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_PREDICTION_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_PREDICTION_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <set>

#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Surface id of a pixel; 0 is the background.
using LabelImage = cv::Mat_<std::uint16_t>;

/// The surfaces of the frame before, rendered into this frame under their
/// predicted motion. All images are empty in the first frame.
struct SurfacePrediction {
  LabelImage labels;      ///< HxW surface ids, 0 = background or nothing.
  cv::Mat_<float> depth;  ///< HxW z-depth of the rendered surface, metres; 0
                          ///< where nothing was rendered.
  /// HxW z-depth of the background alone, behind the surfaces too, metres; 0 =
  /// unknown. May be empty.
  cv::Mat_<float> background;
  /// Predicted pose of the camera of this frame.
  Rigid3d world_from_camera = Rigid3d::Identity();

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(labels, depth, background, world_from_camera);
  }
};

/// The prediction in which labels and live depth of the frame before, `last`,
/// stand in for what it lacks: for everything if it is empty, else for the
/// surfaces of `followed` that it has no pixel of, where it has nothing else.
/// All zero, of this size, if both are empty.
SurfacePrediction CompletePrediction(const SurfacePrediction& prediction,
                                     const SurfacePrediction& last,
                                     const std::set<int>& followed,
                                     cv::Size size);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_PREDICTION_H_
