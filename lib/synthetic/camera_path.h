#ifndef SPLITFUSION_LIB_SYNTHETIC_CAMERA_PATH_H_
#define SPLITFUSION_LIB_SYNTHETIC_CAMERA_PATH_H_

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/synthetic/synthetic_options.h"

namespace splitfusion {

/// A hand-held camera: it sways about its place and looks around its target,
/// with a little shake. World frame: z up.
class CameraPath {
 public:
  /// Place and target follow from the scene; shake from the seed.
  explicit CameraPath(const SyntheticOptions& options);

  /// Camera to world at `time` seconds.
  Rigid3d WorldFromCamera(double time) const;

 private:
  Eigen::Vector3d place_;
  Eigen::Vector3d target_;
  double amplitude_;
  std::uint32_t seed_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_CAMERA_PATH_H_
