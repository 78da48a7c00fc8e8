#ifndef SPLITFUSION_LIB_EVALUATION_POSED_MODEL_H_
#define SPLITFUSION_LIB_EVALUATION_POSED_MODEL_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Depth of the model behind the live depth from which on it is stray, metres,
/// but at least three standard deviations of the depth noise.
constexpr double kStrayMargin = 0.02;
/// Farther behind it is hidden by something else, metres.
constexpr double kStrayReach = 0.15;

/// Model that cannot be where it is.
struct StrayArea {
  double in_view = 0;  ///< Square metres, see MeasureStray().
  double stray = 0;    ///< Of it, behind the live depth.

  /// `stray` / `in_view`; 0 if nothing is in view.
  double Share() const { return in_view > 0 ? stray / in_view : 0; }
};

/// Area of a mesh (camera frame, metres) that is in view: triangles that face
/// the camera and whose centre projects onto a pixel with live depth (HxW,
/// metres, 0 = none). Stray is what lies behind that depth by more than
/// kStrayMargin and no more than kStrayReach.
StrayArea MeasureStray(const TriangleMesh& mesh, const PinholeCamera& camera,
                       const cv::Mat_<float>& live);

/// Of the live depth, within which the model shows it, metres.
constexpr double kShownTolerance = 0.05;

/// HxW mask, 255 where some point of the mesh (camera frame, metres) is within
/// kShownTolerance of the live depth, seen from anywhere, or two pixels beside
/// it.
cv::Mat_<std::uint8_t> ShownPixels(const TriangleMesh& mesh,
                                   const PinholeCamera& camera,
                                   const cv::Mat_<float>& live);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_POSED_MODEL_H_
