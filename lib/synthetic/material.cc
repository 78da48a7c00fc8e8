#include "splitfusion/lib/synthetic/material.h"

#include <cmath>

#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

Vector3f Mix(const Material& m, float amount) {
  return m.first + amount * (m.second - m.first);
}

Vector3i CellOf(const Vector3f& scaled) {
  return scaled.array().floor().cast<int>();
}

bool IsOdd(int value) { return (value & 1) != 0; }

float Fraction(float value) { return value - std::floor(value); }

Vector3f PlaidColor(const Material& m, const Vector3f& scaled) {
  const float band = 0.5f * ((Fraction(scaled.z()) < 0.5f ? 1.0f : 0.0f) +
                             (Fraction(scaled.y()) < 0.5f ? 1.0f : 0.0f));
  const bool line =
      Fraction(scaled.z() + 0.2f) < 0.1f || Fraction(scaled.y() + 0.2f) < 0.1f;
  const Vector3f base = Mix(m, band);
  return line ? Vector3f(0.35f * base + Vector3f::Constant(0.6f)) : base;
}

Vector3f PosterColor(const Material& m, const Vector3f& scaled) {
  const Vector3i c = CellOf(scaled);
  Vector3f color;
  for (int k = 0; k < 3; ++k) {
    color[k] = HashUnit(c.x(), c.y(), c.z(), m.seed + 11u * (k + 1));
  }
  return 0.45f * color + 0.55f * Mix(m, FractalNoise(2 * scaled, 2, m.seed));
}

Vector3f PatternColor(const Material& m, const Vector3f& scaled) {
  switch (m.pattern) {
    case Pattern::kChecker:
      return IsOdd(CellOf(scaled).sum()) ? m.first : m.second;
    case Pattern::kStripes:
      return IsOdd(CellOf(scaled).z()) ? m.first : m.second;
    case Pattern::kPlaid:
      return PlaidColor(m, scaled);
    case Pattern::kWood:
      return Mix(m, FractalNoise(Vector3f(0.15f * scaled.x(), 2 * scaled.y(),
                                          2 * scaled.z()),
                                 3, m.seed));
    case Pattern::kPosters:
      return PosterColor(m, scaled);
    case Pattern::kMottled:
      break;
  }
  return Mix(m, FractalNoise(scaled, 3, m.seed));
}

}  // namespace

Vector3f MaterialColor(const Material& material, const Vector3f& rest_point) {
  // The offset keeps cell borders off the round numbers where walls stand.
  const Vector3f scaled =
      rest_point / material.period + Vector3f(0.371f, 0.283f, 0.417f);
  const Vector3f color = PatternColor(material, scaled);
  // Fine grain, so that no surface is without texture.
  const float grain = FractalNoise(rest_point * 45.0f, 2, material.seed + 97u);
  return color * (0.82f + 0.36f * grain);
}

}  // namespace splitfusion
