#ifndef SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_
#define SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_

namespace splitfusion {

class OptionList;

/// Axial noise of a depth camera; by default that of a structured-light camera
/// (Nguyen et al. 2012). It sets gates, edge thresholds and weights.
struct DepthNoise {
  double least = 0.0012;   ///< Metres, at `best`.
  double growth = 0.0019;  ///< 1 / metres.
  double best = 0.4;       ///< Depth with the least noise, metres.

  /// Depth at which a measurement has the confidence 1, metres: by default
  /// noise of 3 mm.
  double reference = 1.4;

  /// Standard deviation at z-depth `depth` (both metres):
  /// sigma = least + growth (z - best)^2.
  template <typename T>
  T Sigma(T depth) const {
    const T d = depth - T(best);
    return T(least) + T(growth) * d * d;
  }

  /// (sigma(reference) / sigma(depth))^2, at most 1: the weight of a
  /// measurement.
  float Confidence(float depth) const {
    const float ratio = Sigma(static_cast<float>(reference)) / Sigma(depth);
    return ratio < 1 ? ratio * ratio : 1.0f;
  }

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(least, growth, best, reference);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_DEPTH_NOISE_H_
