#pragma GCC optimize("no-trapping-math", "no-math-errno")

#include "splitfusion/lib/geometry/window_planes.h"

#include <cmath>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"

namespace splitfusion {
namespace {

/// One value of each of the pixels.
using Lanes = float __attribute__((vector_size(sizeof(float) * kWindowPixels)));

inline void Load(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

inline void Store(const Lanes& from, float* to) {
  std::memcpy(to, &from, sizeof(Lanes));
}

/// One pixel of each window, 0 where it does not count.
struct Pixel {
  Lanes count, inverse;
};

inline void LoadPixel(const WindowRows& rows, int at, const Lanes& center,
                      const Lanes& gates, Pixel* pixel) {
  const Lanes none = {};
  Lanes depth;
  Load(rows.depth + at, &depth);
  Load(rows.inverse + at, &pixel->inverse);
  const Lanes difference = depth - center;
  const auto counts = (difference < gates) & (difference > -gates);
  pixel->count = counts ? none + 1.0f : none;
  pixel->inverse = counts ? pixel->inverse : none;
}

/// Sums of one row of each window; x in pixels.
struct RowSums {
  Lanes count, x, xx, z, xz;
};

/// `middle`: of the row, from the first pixel of the first row.
inline void SumRow(const WindowRows& rows, int middle, const Lanes& center,
                   const Lanes& gates, RowSums* row) {
  Pixel pixel, left, right;
  LoadPixel(rows, middle, center, gates, &pixel);
  const Lanes none = {};
  *row = {pixel.count, none, none, pixel.inverse, none};
  for (int du = 1; du <= rows.radius; ++du) {
    LoadPixel(rows, middle - du, center, gates, &left);
    LoadPixel(rows, middle + du, center, gates, &right);
    const float x = static_cast<float>(du);
    const Lanes both = right.count + left.count;
    row->count += both;
    row->x += x * (right.count - left.count);
    row->xx += x * x * both;
    row->z += right.inverse + left.inverse;
    row->xz += x * (right.inverse - left.inverse);
  }
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
void SumWindows(const WindowRows& rows, const float depth[kWindowPixels],
                const float gate[kWindowPixels], WindowSums* sums) {
  const Lanes none = {};
  Lanes center, gates;
  Load(depth, &center);
  Load(gate, &gates);
  Lanes sx = none, sy = none, sz = none, sxx = none, sxy = none, syy = none;
  Lanes sxz = none, syz = none, count = none;
  for (int dv = -rows.radius; dv <= rows.radius; ++dv) {
    const float y = static_cast<float>(dv);
    RowSums row;
    SumRow(rows, (dv + rows.radius) * rows.stride + rows.radius, center, gates,
           &row);
    count += row.count;
    sx += row.x;
    sxx += row.xx;
    sz += row.z;
    sxz += row.xz;
    sy += y * row.count;
    syy += y * y * row.count;
    sxy += y * row.x;
    syz += y * row.z;
  }
  const float fx = rows.inverse_fx, fy = rows.inverse_fy;
  Store(fx * sx, sums->x);
  Store(fy * sy, sums->y);
  Store(sz, sums->z);
  Store(fx * fx * sxx, sums->xx);
  Store(fx * fy * sxy, sums->xy);
  Store(fy * fy * syy, sums->yy);
  Store(fx * sxz, sums->xz);
  Store(fy * syz, sums->yz);
  Store(count, sums->count);
}

SPLITFUSION_VECTOR_CLONES
void FitWindowPlanes(const WindowSums& sums, const WindowCenters& centers,
                     float min_count, WindowNormals* normals) {
  const Lanes none = {};
  Lanes n, sx, sy, sz, sxx, sxy, syy, sxz, syz, x;
  Load(sums.count, &n);
  Load(sums.x, &sx);
  Load(sums.y, &sy);
  Load(sums.z, &sz);
  Load(sums.xx, &sxx);
  Load(sums.xy, &sxy);
  Load(sums.yy, &syy);
  Load(sums.xz, &sxz);
  Load(sums.yz, &syz);
  Load(centers.x, &x);
  const Lanes mean_x = sx / n, mean_y = sy / n;
  const Lanes cxx = sxx - sx * mean_x;
  const Lanes cxy = sxy - sx * mean_y;
  const Lanes cyy = syy - sy * mean_y;
  const Lanes cxz = sxz - mean_x * sz;
  const Lanes cyz = syz - mean_y * sz;
  const Lanes determinant = cxx * cyy - cxy * cxy;
  const Lanes a = (cxz * cyy - cyz * cxy) / determinant;
  const Lanes b = (cyz * cxx - cxz * cxy) / determinant;
  const Lanes c = sz / n - a * mean_x - b * mean_y - a * x - b * centers.y;
  const Lanes squared = a * a + b * b + c * c;
  // n . X = d > 0 points away from the camera: turn it round.
  Lanes length = none;
  for (int i = 0; i < kWindowPixels; ++i) length[i] = -std::sqrt(squared[i]);
  const auto known =
      (n >= min_count) & (determinant > 1e-4f * cxx * cyy);  // Maths.
  Store(known ? a / length : none, normals->x);
  Store(known ? b / length : none, normals->y);
  Store(known ? c / length : none, normals->z);
}

}  // namespace splitfusion
