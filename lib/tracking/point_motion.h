#ifndef SPLITFUSION_LIB_TRACKING_POINT_MOTION_H_
#define SPLITFUSION_LIB_TRACKING_POINT_MOTION_H_

#include <Eigen/Core>

namespace splitfusion {

/// A point of a surface that was seen in two frames, each time lifted by the
/// depth of its pixel; metres.
struct PointMotion {
  Eigen::Vector3f from;  ///< Where it was.
  Eigen::Vector3f to;    ///< Where it is.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_POINT_MOTION_H_
