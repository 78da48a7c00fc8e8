#include "splitfusion/lib/synthetic/hash_noise.h"

#include <cmath>

namespace splitfusion {

float ValueNoise(const Eigen::Vector3f& point, std::uint32_t seed) {
  int cell[3];
  float blend[3];
  for (int k = 0; k < 3; ++k) {
    const float base = std::floor(point[k]);
    const float f = point[k] - base;
    cell[k] = static_cast<int>(base);
    blend[k] = f * f * (3.0f - 2.0f * f);
  }
  float value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const float weight = (dx ? blend[0] : 1 - blend[0]) *
                         (dy ? blend[1] : 1 - blend[1]) *
                         (dz ? blend[2] : 1 - blend[2]);
    value += weight * HashUnit(cell[0] + dx, cell[1] + dy, cell[2] + dz, seed);
  }
  return value;
}

float FractalNoise(const Eigen::Vector3f& point, int octaves,
                   std::uint32_t seed) {
  float sum = 0, total = 0, amplitude = 1;
  Eigen::Vector3f p = point;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * ValueNoise(p, seed + static_cast<std::uint32_t>(i));
    total += amplitude;
    amplitude *= 0.5f;
    p *= 2.03f;
  }
  return sum / total;
}

}  // namespace splitfusion
