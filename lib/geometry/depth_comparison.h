#ifndef SPLITFUSION_LIB_GEOMETRY_DEPTH_COMPARISON_H_
#define SPLITFUSION_LIB_GEOMETRY_DEPTH_COMPARISON_H_

#include <cmath>
#include <cstdint>

#include "splitfusion/lib/geometry/depth_noise.h"

namespace splitfusion {

/// Depths that differ by more standard deviations differ by more than noise.
constexpr double kNoiseSigmas = 3;

/// By how much two depths may differ and be of the same surface: some metres
/// and some standard deviations of the sensor.
template <typename T>
struct DepthTolerance {
  T base = 0;               ///< Metres.
  T sigmas = kNoiseSigmas;  ///< Of the noise.

  /// At z-depth `depth`, metres, of a sensor with this noise.
  template <typename Z>
  auto At(Z depth, const DepthNoise& noise) const {
    return base + sigmas * noise.Sigma(depth);
  }
};

/// Depths within it are equal but for noise.
constexpr DepthTolerance<float> kNoiseAlone;

/// Depths within it may be of one body; beyond, something else is there.
constexpr DepthTolerance<float> kOneBody = {0.1f};

/// What the live depth of a pixel says about a model point that is seen there.
enum class DepthState : std::uint8_t {
  kUnmeasured = 0,  ///< Nothing: there is no live depth, or no model.
  kObserved = 1,    ///< The point is seen.
  kOccluded = 2,    ///< Something in front of it is seen.
  kFree = 3,        ///< Something behind it is seen: it is not there.
};

/// Compares z-depths, metres; 0 or less: none. `tolerance`: metres.
template <typename T, typename Tolerance>
DepthState ClassifyDepth(T live, T model, Tolerance tolerance) {
  if (!(live > 0 && model > 0)) return DepthState::kUnmeasured;
  if (live < model - tolerance) return DepthState::kOccluded;
  return live > model + tolerance ? DepthState::kFree : DepthState::kObserved;
}

/// Whether neighbouring pixels with these z-depths show different surfaces;
/// metres.
template <typename T>
bool IsDepthJump(T depth, T neighbor, T tolerance) {
  return std::abs(neighbor - depth) > tolerance;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_DEPTH_COMPARISON_H_
