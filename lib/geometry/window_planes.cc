#include "splitfusion/lib/geometry/window_planes.h"

#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"

namespace splitfusion {
namespace {

/// One value of each of the pixels.
using Lanes = float __attribute__((vector_size(sizeof(float) * kWindowPixels)));

inline void Load(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
void SumWindows(const WindowRows& rows, const float depth[kWindowPixels],
                const float gate[kWindowPixels],
                WindowSums sums[kWindowPixels]) {
  const Lanes none = {};
  Lanes center, gates, other, inverse;
  Load(depth, &center);
  Load(gate, &gates);
  Lanes sx = none, sy = none, sz = none, sxx = none, sxy = none, syy = none;
  Lanes sxz = none, syz = none, count = none;
  for (int dv = -rows.radius; dv <= rows.radius; ++dv) {
    const float y = dv * rows.inverse_fy;
    const int row = (dv + rows.radius) * rows.stride + rows.radius;
    for (int du = -rows.radius; du <= rows.radius; ++du) {
      Load(rows.depth + row + du, &other);
      Load(rows.inverse + row + du, &inverse);
      const float x = du * rows.inverse_fx;
      const Lanes difference = other - center;
      const auto counts = (difference < gates) & (difference > -gates);
      const Lanes z = counts ? inverse : none;
      sx += counts ? none + x : none;
      sy += counts ? none + y : none;
      sz += z;
      sxx += counts ? none + x * x : none;
      sxy += counts ? none + x * y : none;
      syy += counts ? none + y * y : none;
      sxz += x * z;
      syz += y * z;
      count += counts ? none + 1.0f : none;
    }
  }
  for (int i = 0; i < kWindowPixels; ++i) {
    sums[i] = {sx[i],  sy[i],  sz[i],  sxx[i],  sxy[i],
               syy[i], sxz[i], syz[i], count[i]};
  }
}

}  // namespace splitfusion
