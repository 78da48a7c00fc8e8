#include "splitfusion/lib/geometry/camera.h"

#include <cmath>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

PinholeCamera PinholeCamera::Subsampled(int stride) const {
  PinholeCamera camera;
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
  CheckOption(std::isfinite(fx) && fx > 0, "camera fx", fx,
              "a positive focal length in pixels");
  CheckOption(std::isfinite(fy) && fy > 0, "camera fy", fy,
              "a positive focal length in pixels");
  CheckOption(std::isfinite(cx), "camera cx", cx, "a number in pixels");
  CheckOption(std::isfinite(cy), "camera cy", cy, "a number in pixels");
}

}  // namespace splitfusion
