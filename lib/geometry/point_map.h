#ifndef SPLITFUSION_LIB_GEOMETRY_POINT_MAP_H_
#define SPLITFUSION_LIB_GEOMETRY_POINT_MAP_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/depth_noise.h"

namespace splitfusion {

/// Organised points of one depth image, camera frame, metres.
struct PointMap {
  cv::Mat_<cv::Vec3f> points;   ///< HxW; (0,0,0) where there is no depth.
  cv::Mat_<cv::Vec3f> normals;  ///< HxW; towards the camera; 0 = unknown.
  DepthNoise noise{};           ///< Of the depth.
  int radius = 0;  ///< Of the windows of the normals, pixels; 0: exact ones.

  /// Standard deviation of a normal about either axis, radians, where the depth
  /// is `z`, metres: of the slope of the plane through the window's points,
  /// whose noise is independent; `focal` pixels.
  float NormalSigma(float z, double focal) const;
};

/// A point or a normal of such a map.
inline Eigen::Vector3f ToEigen(const cv::Vec3f& v) {
  return {v[0], v[1], v[2]};
}

/// The same the other way.
inline cv::Vec3f ToCv(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

/// How points and normals are computed from depth.
struct PointMapOptions {
  /// Half width of the window over which a plane is fitted, pixels. Kinect
  /// noise is correlated over about 1 pixel, so a wide window pays.
  int radius = 3;
  /// Neighbours whose depth differs from the centre by more than
  /// `edge_factor` x sigma(z) + `edge_offset` (metres) do not count.
  double edge_factor = 4.0;
  /// Metres, see edge_factor.
  double edge_offset = 0.004;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// Lifts an HxW 32FC1 depth image (metres, 0 = none) to points, and fits a
/// plane around every pixel for its normal.
///
/// @throw InputError if the image's type or size does not fit the camera.
PointMap ComputePointMap(const cv::Mat& depth, const PinholeCamera& camera,
                         const PointMapOptions& options = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_POINT_MAP_H_
