#ifndef SPLITFUSION_LIB_SYNTHETIC_HASH_NOISE_H_
#define SPLITFUSION_LIB_SYNTHETIC_HASH_NOISE_H_

#include <Eigen/Core>
#include <cstdint>

namespace splitfusion {

/// 32 well-mixed bits of a lattice cell and a seed: a random number without a
/// state, the same on every machine and in every thread.
inline std::uint32_t HashCell(int x, int y, int z, std::uint32_t seed) {
  std::uint32_t h = seed * 0x9e3779b1u;
  for (const int value : {x, y, z}) {
    h ^= static_cast<std::uint32_t>(value) * 0x85ebca6bu;
    h = (h << 13) | (h >> 19);
    h = h * 5u + 0xe6546b64u;
  }
  h ^= h >> 16;
  h *= 0xc2b2ae35u;
  return h ^ (h >> 13);
}

/// The same as a number in [0, 1).
inline float HashUnit(int x, int y, int z, std::uint32_t seed) {
  return static_cast<float>(HashCell(x, y, z, seed) >> 8) * (1.0f / 16777216);
}

/// Smooth random function of space in [0, 1): lattice values of unit spacing,
/// blended with a continuous first derivative.
float ValueNoise(const Eigen::Vector3f& point, std::uint32_t seed);

/// Sum of `octaves` value noises of halving size and amplitude, in [0, 1).
float FractalNoise(const Eigen::Vector3f& point, int octaves,
                   std::uint32_t seed);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_HASH_NOISE_H_
