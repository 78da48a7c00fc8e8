#ifndef SPLITFUSION_LIB_SYNTHETIC_KINECT_NOISE_H_
#define SPLITFUSION_LIB_SYNTHETIC_KINECT_NOISE_H_

#include <cstdint>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// Errors of a structured-light camera (Kinect v1, Xtion).
struct KinectNoiseOptions {
  /// Part of the axial variance that neighbouring pixels share.
  double correlated_part = 0.85;
  double correlation_px = 1.1;       ///< Its radius at 640 pixels of width.
  double lateral_px = 0.6;           ///< Shift of depth edges at 640 pixels.
  double disparity_step_px = 0.125;  ///< Of the sensor's own disparity.
  double focal_times_baseline = 575.8 * 0.075;  ///< Pixels x metres.
  double edge_loss = 0.35;      ///< Chance to lose a pixel at a depth edge.
  double grazing_degrees = 74;  ///< No depth beyond this angle of incidence.
  double min_depth = 0.5;       ///< Metres.
  double max_depth = 4.5;       ///< Metres.
};

/// Makes a measured depth image out of an exact one (32FC1, metres, 0 = none).
///
/// Axial noise of sigma = 0.0012 + 0.0019 (z - 0.4)^2 m (Nguyen et al. 2012,
/// quantisation included), disparity steps, edges that wobble by a pixel, and
/// losses: at edges, at grazing incidence, in the projector's shadow (left of
/// near things), in blobs, and outside the range. The same seed gives the same
/// image.
///
/// @throw InputError if the image does not fit the camera.
cv::Mat ApplyKinectNoise(const cv::Mat& exact_depth,
                         const PinholeCamera& camera, std::uint32_t seed,
                         const KinectNoiseOptions& options = {});

/// Image of independent Gaussian numbers of mean 0 and variance 1, blurred by
/// `correlation_px` (the variance stays 1).
cv::Mat_<float> CorrelatedNoise(const cv::Size& size, double correlation_px,
                                std::uint32_t seed);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_KINECT_NOISE_H_
