#ifndef SPLITFUSION_LIB_GEOMETRY_RIGID3_H_
#define SPLITFUSION_LIB_GEOMETRY_RIGID3_H_

#include <Eigen/Geometry>
#include <cmath>

namespace splitfusion {

/// Rigid motion; `b_from_a` maps points of frame a into frame b. Metres.
using Rigid3d = Eigen::Isometry3d;
/// The same in single precision, for images and grids.
using Rigid3f = Eigen::Isometry3f;

/// Rotation of the rotation vector `omega` (axis times angle, radians).
inline Eigen::Matrix3d ExpSo3(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  if (angle < 1e-12) {
    Eigen::Matrix3d skew;
    skew << 0, -omega.z(), omega.y(), omega.z(), 0, -omega.x(), -omega.y(),
        omega.x(), 0;
    return Eigen::Matrix3d::Identity() + skew;
  }
  return Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
}

/// Angle of the rotation part, radians in [0, pi].
inline double RotationAngle(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

/// Nearest rotation matrix, through a normalised quaternion; undoes the drift
/// of long products.
inline Eigen::Matrix3d Orthonormalized(const Eigen::Matrix3d& rotation) {
  return Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_RIGID3_H_
