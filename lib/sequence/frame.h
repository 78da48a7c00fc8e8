#ifndef SPLITFUSION_LIB_SEQUENCE_FRAME_H_
#define SPLITFUSION_LIB_SEQUENCE_FRAME_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// One RGB-D frame; colour and depth are of equal size, and registered unless
/// Calibration::color says otherwise.
struct Frame {
  int index = 0;         ///< Position in the sequence, from 0.
  double timestamp = 0;  ///< Of the depth image, seconds.
  std::string stem;      ///< Depth file's name without folder and extension.
  std::string color_stem = {};  ///< The same of the colour file.
  cv::Mat color;                ///< HxW 8UC3, BGR.
  cv::Mat depth;                ///< HxW 32FC1, metres, 0 = no measurement.
  /// Where the camera is, if that is given, see ReaderOptions::trajectory; in
  /// the world of that file.
  std::optional<Rigid3d> world_from_camera = {};
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_FRAME_H_
