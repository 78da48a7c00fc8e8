#ifndef SPLITFUSION_LIB_SEQUENCE_DEPTH_FILTER_H_
#define SPLITFUSION_LIB_SEQUENCE_DEPTH_FILTER_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/depth_noise.h"

namespace splitfusion {

/// What is known of a depth sensor, and of its depth used.
struct DepthOptions {
  double min_depth = 0.4;  ///< Metres; nearer measurements are dropped.
  double max_depth = 5.0;  ///< Metres; farther measurements are dropped.

  DepthNoise noise;  ///< Of the sensor.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// Metres of an HxW 16UC1 depth image with `depth_scale` units a metre, as
/// 32FC1; 0 stays 0. An image of 32FC1 is in metres already; what is not a
/// positive number in it becomes 0.
cv::Mat DepthInMetres(const cv::Mat& raw, double depth_scale);

/// Sets measurements outside of [min_depth, max_depth] (metres) to 0.
void RemoveOutOfRange(double min_depth, double max_depth, cv::Mat* depth);

/// Drops flying pixels: those with one neighbour clearly nearer and the
/// opposite one clearly farther than themselves, and with hardly any neighbour
/// at their own depth. "Clearly" is five times the axial noise and 1 cm.
void RemoveFlyingPixels(const DepthNoise& noise, cv::Mat* depth);

/// Applies range and flying-pixel removal, in this order, to an HxW 32FC1 depth
/// image (metres, 0 = none).
cv::Mat FilterDepth(const cv::Mat& depth, const DepthOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_DEPTH_FILTER_H_
