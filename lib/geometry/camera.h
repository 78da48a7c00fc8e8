#ifndef SPLITFUSION_LIB_GEOMETRY_CAMERA_H_
#define SPLITFUSION_LIB_GEOMETRY_CAMERA_H_

#include <Eigen/Core>
#include <optional>

#include "splitfusion/lib/geometry/depth_noise.h"

namespace splitfusion {

/// What is nearer to a camera than this is not seen, metres.
constexpr float kNearPlane = 0.05f;

/// Pinhole camera without distortion. Camera frame: x right, y down, z forward;
/// pixel (0, 0) is the centre of the top-left pixel.
struct PinholeCamera {
  int width = 0;       ///< Pixels.
  int height = 0;      ///< Pixels.
  double fx = 0;       ///< Focal length, pixels.
  double fy = 0;       ///< Focal length, pixels.
  double cx = 0;       ///< Principal point, pixels.
  double cy = 0;       ///< Principal point, pixels.
  DepthNoise noise{};  ///< Of its depth images.

  /// Pixel of a point of the camera frame (metres); the point must have z > 0.
  template <typename T>
  Eigen::Matrix<T, 2, 1> Project(const Eigen::Matrix<T, 3, 1>& point) const {
    return {T(fx) * point.x() / point.z() + T(cx),
            T(fy) * point.y() / point.z() + T(cy)};
  }

  /// Pixel that `place`, as of Project(), lies in; none beyond the image.
  std::optional<Eigen::Vector2i> PixelAt(const Eigen::Vector2f& place) const {
    // The middle of pixel 0 is at 0.
    const float u = place.x() + 0.5f, v = place.y() + 0.5f;
    if (!(u > 0 && v > 0 && u < static_cast<float>(width) &&
          v < static_cast<float>(height))) {
      return std::nullopt;
    }
    return Eigen::Vector2i(static_cast<int>(u), static_cast<int>(v));
  }

  /// Pixel that shows a point of the camera frame, metres; none if the point is
  /// nearer than kNearPlane or beyond the image.
  std::optional<Eigen::Vector2i> PixelOf(const Eigen::Vector3f& point) const {
    if (!(point.z() > kNearPlane)) return std::nullopt;
    return PixelAt(Project(point));
  }

  /// Point of the camera frame at pixel (u, v) and z-depth `depth` (metres).
  template <typename T>
  Eigen::Matrix<T, 3, 1> BackProject(T u, T v, T depth) const {
    return {(u - T(cx)) / T(fx) * depth, (v - T(cy)) / T(fy) * depth, depth};
  }

  /// Camera of the image that keeps every `stride`-th pixel of every
  /// `stride`-th row, beginning with pixel (0, 0).
  PinholeCamera Subsampled(int stride) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(width, height, fx, fy, cx, cy, noise);
  }

  /// @throw InputError if a size or focal length is not positive, or a view ray
  ///     leans by more than 79 degrees (wrong units).
  void Check() const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_CAMERA_H_
