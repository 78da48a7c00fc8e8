#ifndef SPLITFUSION_LIB_BASE_NORMAL_NOISE_H_
#define SPLITFUSION_LIB_BASE_NORMAL_NOISE_H_

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "splitfusion/lib/base/mixed_bits.h"
#include "splitfusion/lib/base/pi.h"

namespace splitfusion {

/// Three independent normally distributed numbers, mean 0 and deviation 1, that
/// depend on what they are asked for alone, not on the order in which they are:
/// hashes of the arguments, by Box and Muller.
inline Eigen::Vector3d NormalNoise(std::uint64_t seed, int a, int b, int c) {
  std::uint64_t key = MixedBits(seed + 0x9e3779b97f4a7c15ULL);
  for (const int part : {a, b, c}) {
    key = MixedBits(key + static_cast<std::uint32_t>(part) +
                    0x9e3779b97f4a7c15ULL);
  }
  // In (0, 1].
  const auto uniform = [&key] {
    key += 0x9e3779b97f4a7c15ULL;
    return std::ldexp(static_cast<double>((MixedBits(key) >> 11) + 1), -53);
  };
  const double near = std::sqrt(-2 * std::log(uniform()));
  const double angle = 2 * kPi<double> * uniform();
  const double other = std::sqrt(-2 * std::log(uniform()));
  return {near * std::cos(angle), near * std::sin(angle),
          other * std::cos(2 * kPi<double> * uniform())};
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_NORMAL_NOISE_H_
