#ifndef SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_
#define SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_

namespace splitfusion {

/// Pixels that are summed up at a time.
constexpr int kWindowPixels = 8;  // Speed.

/// Sums over the pixels around some, of those at about the depth of each: x, y
/// relative to the pixel in normalised image coordinates, z the inverse depth.
struct WindowSums {
  float x[kWindowPixels];      ///< Of x.
  float y[kWindowPixels];      ///< Of y.
  float z[kWindowPixels];      ///< Of z.
  float xx[kWindowPixels];     ///< Of x x.
  float xy[kWindowPixels];     ///< Of x y.
  float yy[kWindowPixels];     ///< Of y y.
  float xz[kWindowPixels];     ///< Of x z.
  float yz[kWindowPixels];     ///< Of y z.
  float count[kWindowPixels];  ///< Pixels that count.
};

/// Depth and inverse depth of the rows of a window, one below the other.
struct WindowRows {
  const float* depth;    ///< First pixel of the first row; 0 = none.
  const float* inverse;  ///< The same of the inverse depth.
  int stride;            ///< Pixels from one row to the next.
  int radius;            ///< The window is 2 radius + 1 wide and high.
  float inverse_fx;      ///< Of the camera.
  float inverse_fy;      ///< Of the camera.
};

/// Sums of the windows around kWindowPixels pixels of a row. The first window
/// begins at `rows.depth`; the pixel (du, dv) of a window counts if its depth
/// is within `gate` of `depth` of its centre.
void SumWindows(const WindowRows& rows, const float depth[kWindowPixels],
                const float gate[kWindowPixels], WindowSums* sums);

/// Where the pixels of the windows are, in normalised image coordinates.
struct WindowCenters {
  float x[kWindowPixels];  ///< (u - cx) / fx.
  float y;                 ///< (v - cy) / fy.
};

/// Unit normals, towards the camera; 0 = unknown.
struct WindowNormals {
  float x[kWindowPixels];  ///< To the right.
  float y[kWindowPixels];  ///< Down.
  float z[kWindowPixels];  ///< Away from the camera.
};

/// Normals of the planes a x + b y + c = 1 / z fitted to windows. A plane of
/// space is linear in (u, v, 1/z), so that the fit has no bias on slopes:
/// n . X = d with X = z ((u-cx)/fx, (v-cy)/fy, 1) gives
/// 1/z = (n_x (u-cx)/fx + n_y (v-cy)/fy + n_z) / d.
/// Unknown where fewer than `min_count` pixels count or all lie on a line.
void FitWindowPlanes(const WindowSums& sums, const WindowCenters& centers,
                     float min_count, WindowNormals* normals);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_
