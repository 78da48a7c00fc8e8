#ifndef SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_
#define SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_

namespace splitfusion {

constexpr double kLeastDepthSigma = 0.0012;   ///< Of DepthSigma(), metres.
constexpr double kDepthSigmaGrowth = 0.0019;  ///< The same, 1 / metres.
constexpr double kBestDepth = 0.4;            ///< The same, metres.

/// Axial noise of a structured-light camera at z-depth `depth` (both metres):
/// sigma = 0.0012 + 0.0019 (z - 0.4)^2 (Nguyen et al. 2012). It sets weights
/// and edge thresholds; its shape matters, its scale does not.
template <typename T>
T DepthSigma(T depth) {
  const T d = depth - T(kBestDepth);
  return T(kLeastDepthSigma) + T(kDepthSigmaGrowth) * d * d;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_
