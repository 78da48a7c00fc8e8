#ifndef SPLITFUSION_LIB_SEQUENCE_CALIBRATION_H_
#define SPLITFUSION_LIB_SEQUENCE_CALIBRATION_H_

#include <optional>
#include <string>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/color_camera.h"
#include "splitfusion/lib/sequence/lens_distortion.h"

namespace splitfusion {

/// Intrinsics and depth scale of a sequence, and the lenses of its image files.
struct Calibration {
  PinholeCamera camera;    ///< Intrinsics.
  double depth_scale = 0;  ///< Depth image units in a metre (TUM: 5000).
  /// Of colour images that are known not to be registered to the depth images.
  std::optional<ColorCamera> color = {};
  /// Distortion of the files of depth, and of registered colour.
  LensDistortion lens = {};
  /// Whether a file says which that is, if only that there is none.
  bool lens_is_stated = false;
  /// Distortion of the files of `color`.
  LensDistortion color_lens = {};

  /// @throw InputError if the camera or the scale is out of range.
  void Check() const;
};

/// Reads `calibration.txt`: one line `fx fy cx cy width height depth_factor`,
/// `#` comments.
///
/// @throw InputError on a missing file, a value that does not parse or one
/// more.
Calibration ReadCalibrationLine(const std::string& path);

/// Writes that line, with a comment that names the values. Reading it gives the
/// same calibration.
///
/// @throw InputError if the file cannot be written.
void WriteCalibration(const std::string& path, const Calibration& calibration);

/// Reads `camera.txt`: `key value` lines with the keys width, height, fx, fy,
/// cx, cy, depth_scale; optional are those of a lens (kDistortionKeys), and of
/// a colour camera apart: color_width, color_height, color_fx, color_fy,
/// color_cx, color_cy, and where that differs from none color_tx to color_tz
/// (metres), color_qx to color_qw (colour from depth), color_k1 to color_k6.
/// `#` comments.
///
/// @throw InputError on a missing file, an unknown, repeated or missing key.
Calibration ReadCalibrationKeys(const std::string& path);

/// Writes `camera.txt`; reading it gives the same calibration.
///
/// @throw InputError if the file cannot be written.
void WriteCalibrationKeys(const std::string& path,
                          const Calibration& calibration);

/// Reads `calibration.txt` or else `camera.txt` of a folder; empty if there is
/// neither.
///
/// @throw InputError if the file is there but broken.
std::optional<Calibration> FindCalibration(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_CALIBRATION_H_
