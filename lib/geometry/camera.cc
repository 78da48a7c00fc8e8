#include "splitfusion/lib/geometry/camera.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/focal_length.h"

namespace splitfusion {
namespace {

/// Largest |x/z| or |y/z| of a view ray: 79 degrees off the axis, beyond any
/// lens that is a pinhole. A slip in a calibration file gives far more, and
/// volumes that no memory holds.
constexpr double kMaxSlope = 5;  // Format.

/// Intrinsics along one axis of the image.
void CheckFieldOfView(const std::string& axis, double f, double c, int size) {
  std::ostringstream field;
  field << "camera c" << axis << " = " << c << ", size = " << size << ", f"
        << axis;
  CheckOption(std::max(std::abs(c), std::abs(size - c)) <= kMaxSlope * f,
              field.str(), f,
              "pixels that keep all view rays within 79 degrees of the axis");
}

}  // namespace

PinholeCamera PinholeCamera::Subsampled(int stride) const {
  PinholeCamera camera = *this;
  camera.width = (width + stride - 1) / stride;
  camera.height = (height + stride - 1) / stride;
  camera.fx = fx / stride;
  camera.fy = fy / stride;
  camera.cx = cx / stride;
  camera.cy = cy / stride;
  return camera;
}

void PinholeCamera::Check() const {
  CheckOption(width > 0, "camera width", width, "a positive size in pixels");
  CheckOption(height > 0, "camera height", height, "a positive size in pixels");
  CheckFocalLength("camera fx", fx);
  CheckFocalLength("camera fy", fy);
  CheckOption(std::isfinite(cx), "camera cx", cx, "a number in pixels");
  CheckOption(std::isfinite(cy), "camera cy", cy, "a number in pixels");
  CheckFieldOfView("x", fx, cx, width);
  CheckFieldOfView("y", fy, cy, height);
}

}  // namespace splitfusion
