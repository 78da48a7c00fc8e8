#ifndef SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_
#define SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_

namespace splitfusion {

/// Sums over the pixels around one, of those at about its depth: x, y relative
/// to the pixel in normalised image coordinates, z the inverse depth.
struct WindowSums {
  float x = 0;      ///< Of x.
  float y = 0;      ///< Of y.
  float z = 0;      ///< Of z.
  float xx = 0;     ///< Of x x.
  float xy = 0;     ///< Of x y.
  float yy = 0;     ///< Of y y.
  float xz = 0;     ///< Of x z.
  float yz = 0;     ///< Of y z.
  float count = 0;  ///< Pixels that count.
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

/// Pixels that are summed up at a time.
constexpr int kWindowPixels = 8;

/// Sums of the windows around kWindowPixels pixels of a row. The first window
/// begins at `rows.depth`; the pixel (du, dv) of a window counts if its depth
/// is within `gate` of `depth` of its centre.
void SumWindows(const WindowRows& rows, const float depth[kWindowPixels],
                const float gate[kWindowPixels],
                WindowSums sums[kWindowPixels]);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_WINDOW_PLANES_H_
