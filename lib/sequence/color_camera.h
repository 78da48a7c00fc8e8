#ifndef SPLITFUSION_LIB_SEQUENCE_COLOR_CAMERA_H_
#define SPLITFUSION_LIB_SEQUENCE_COLOR_CAMERA_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// The colour camera of a recording whose colour images are not registered to
/// the depth images: another camera, beside the depth camera. Pinhole, without
/// distortion.
struct ColorCamera {
  double fx = 0;   ///< Focal length, pixels.
  double fy = 0;   ///< Focal length, pixels.
  double cx = 0;   ///< Principal point, pixels.
  double cy = 0;   ///< Principal point, pixels.
  int width = 0;   ///< Of its images, pixels; 0 = that of the depth images.
  int height = 0;  ///< Of its images, pixels; 0 = that of the depth images.
  /// Maps a point of the depth camera's frame into the colour camera's, metres.
  Rigid3d color_from_depth = Rigid3d::Identity();

  /// One that sees what the depth camera sees: registered colour.
  static ColorCamera Registered(const PinholeCamera& depth_camera);

  /// Size of its images; `depth_size`: that of the depth images.
  cv::Size SizeBeside(const cv::Size& depth_size) const {
    return width > 0 ? cv::Size(width, height) : depth_size;
  }

  /// @throw InputError if a focal length is not positive, a value is not a
  ///     finite number, or it is not beside the depth camera.
  void Check() const;
};

/// The file's name in a sequence folder and in a run directory.
constexpr const char* kColorCameraFile = "color_camera.txt";  // Format.

/// Reads it: one line `fx fy cx cy tx ty tz qx qy qz qw`, and `width height` if
/// the colour images have another size than the depth images; `#` comments.
/// Intrinsics in pixels, then colour from depth as in a TUM trajectory, metres.
///
/// @throw InputError on a missing file, a value that does not parse or one
///     more, or that is out of its range.
ColorCamera ReadColorCamera(const std::string& path);

/// That line: reading it gives the same camera.
std::string ToText(const ColorCamera& camera);

/// Writes it, with a comment that names the values.
///
/// @throw InputError if the file cannot be written.
void WriteColorCamera(const std::string& path, const ColorCamera& camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_COLOR_CAMERA_H_
