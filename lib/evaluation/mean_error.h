#ifndef SPLITFUSION_LIB_EVALUATION_MEAN_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_MEAN_ERROR_H_

#include <vector>

#include "splitfusion/lib/evaluation/instance_error.h"
#include "splitfusion/lib/evaluation/surface_error.h"

namespace splitfusion {

/// Means of every figure over several sets of errors, each with equal weight;
/// of `max` the largest, of `count` the sum. Empty sets are left out.
ErrorStatistics MeanOf(std::vector<ErrorStatistics> items);

/// Means of every figure over several comparisons, each with equal weight; of
/// `max` the largest, of `count` the sum. Zero if there is none.
SurfaceDistances MeanOf(const std::vector<SurfaceDistances>& items);

/// The same for surface errors.
SurfaceError MeanOf(const std::vector<SurfaceError>& items);

/// Error of an instance over its frames.
struct InstanceMeans {
  int surface_frames = 0;  ///< Frames in which the surface was tracked, or
                           ///< the instance is missing.
  int frames_missing = 0;  ///< The latter.
  SurfaceError surface;    ///< Means over these frames.
  SurfaceError shown;      ///< Means over those in which it is not missing.
  int view_frames = 0;     ///< Frames in which the camera sees the instance.
  ViewError view;          ///< Means over these frames; pixels are sums.
};

/// The same for one instance.
InstanceMeans MeanOf(const InstanceError& instance);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_MEAN_ERROR_H_
