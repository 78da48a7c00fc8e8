#ifndef SPLITFUSION_LIB_TSDF_SAMPLE_DISTANCE_H_
#define SPLITFUSION_LIB_TSDF_SAMPLE_DISTANCE_H_

#include <Eigen/Core>
#include <optional>

namespace splitfusion {

class TsdfVolume;

/// The signed distance of a volume at one place.
struct DistanceSample {
  double distance = 0;  ///< Metres; positive in front of the surface.
  /// Its derivative by the place, metres a metre; canonical.
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// The signed distance at a canonical point (metres), trilinear between voxels;
/// none where one of the eight voxels around was never observed. Thread-safe.
std::optional<DistanceSample> SampleDistance(const TsdfVolume& volume,
                                             const Eigen::Vector3d& point);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_SAMPLE_DISTANCE_H_
