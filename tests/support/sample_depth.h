#ifndef SPLITFUSION_TESTS_SUPPORT_SAMPLE_DEPTH_H_
#define SPLITFUSION_TESTS_SUPPORT_SAMPLE_DEPTH_H_

#include <functional>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// 160x120 pixels, 63 degrees wide.
PinholeCamera SmallCamera();

/// Exact depth of the plane n . x = d (camera frame, metres), HxW.
cv::Mat_<float> PlaneDepth(const PinholeCamera& camera,
                           const Eigen::Vector3d& normal, double d);

/// Exact depth of a wall at z-depth `z` that faces the camera.
cv::Mat_<float> WallDepth(const PinholeCamera& camera, double z);

/// Exact depth of a sphere; 0 beside it.
cv::Mat_<float> SphereDepth(const PinholeCamera& camera,
                            const Eigen::Vector3d& center, double radius);

/// Depth of a mesh (camera frame); 0 beside it.
cv::Mat_<float> MeshDepth(const PinholeCamera& camera,
                          const TriangleMesh& mesh);

/// An image of one colour, 8UC3.
cv::Mat PlainColor(const PinholeCamera& camera, const cv::Vec3b& bgr);

/// The depth as an observation in which every pixel writes with weight 1; red.
DepthObservation ObserveAll(const PinholeCamera& camera,
                            const cv::Mat_<float>& depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SAMPLE_DEPTH_H_
