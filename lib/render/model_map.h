#ifndef SPLITFUSION_LIB_RENDER_MODEL_MAP_H_
#define SPLITFUSION_LIB_RENDER_MODEL_MAP_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// A rendered model: what a camera would see of it. All images HxW of the
/// camera; camera frame, metres; points with z = 0 where nothing is.
struct ModelMap {
  /// Camera that the model was rendered for.
  PinholeCamera camera;
  /// Camera frame, metres; z = 0 where nothing is.
  cv::Mat_<cv::Vec3f> points;
  cv::Mat_<cv::Vec3f> normals;  ///< Unit length; 0 where nothing is.
  cv::Mat_<cv::Vec3b> color;    ///< BGR.

  /// Allocates and empties the images for a camera.
  void Clear(const PinholeCamera& model_camera) {
    camera = model_camera;
    points.create(camera.height, camera.width);
    normals.create(camera.height, camera.width);
    color.create(camera.height, camera.width);
    points.setTo(cv::Scalar::all(0));
    normals.setTo(cv::Scalar::all(0));
    color.setTo(cv::Scalar::all(0));
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_MODEL_MAP_H_
