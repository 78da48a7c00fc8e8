#ifndef SPLITFUSION_LIB_ENERGY_UNKNOWN_H_
#define SPLITFUSION_LIB_ENERGY_UNKNOWN_H_

#include <ceres/jet.h>

#include <array>
#include <string>
#include <vector>

namespace splitfusion {

/// Where an unknown begins a frame; the solves of a frame after the first one
/// begin where the one before left it.
enum class UnknownStart {
  kInitial,      ///< At its initial value.
  kFrameBefore,  ///< Where the surface was tracked last.
  /// Where the background of this frame has left it, which is tracked first, as
  /// of a number that belongs to the camera; of the background itself as
  /// kFrameBefore.
  kBackground
};

/// A number that a term estimates together with the motions, beside the twists
/// of the nodes: brightness of the live image, scale of its depth.
struct Unknown {
  /// Letters, digits and _; another one for each unknown of a term.
  std::string name;
  std::string unit;    ///< Of its value; may be empty.
  double initial = 0;  ///< Value at the begin, see `start`.
  /// A change of the value that counts as much as one radian or one metre:
  /// solvers seek value / scale.
  double scale = 1;
  /// What it begins a frame with; the initial value where that is not known.
  UnknownStart start = UnknownStart::kInitial;
};

namespace internal {

/// Number of unknowns that a functor takes: its kUnknowns, or 0 if it has none.
template <typename Functor, typename = void>
struct UnknownsOf {
  static constexpr int kCount = 0;  // Layout.
};
template <typename Functor>
struct UnknownsOf<Functor, decltype(void(Functor::kUnknowns))> {
  static constexpr int kCount = Functor::kUnknowns;
};

/// The values of unknowns that are `sought` in units of their scales.
template <int kCount>
std::array<double, kCount> ValuesOf(const std::vector<double>& scales,
                                    const double* sought) {
  std::array<double, kCount> values;
  for (int u = 0; u < kCount; ++u) values[u] = scales[u] * sought[u];
  return values;
}

/// The same as Jets of `kSize`, which differentiate by what is sought; that is
/// number `first` and those that follow.
template <int kSize, int kCount>
std::array<ceres::Jet<double, kSize>, kCount> JetsOf(
    const std::vector<double>& scales, const double* sought, int first) {
  std::array<ceres::Jet<double, kSize>, kCount> jets;
  for (int u = 0; u < kCount; ++u) {
    jets[u] = ceres::Jet<double, kSize>(scales[u] * sought[u]);
    jets[u].v[first + u] = scales[u];
  }
  return jets;
}

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_UNKNOWN_H_
