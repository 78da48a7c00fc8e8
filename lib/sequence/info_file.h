#ifndef SPLITFUSION_LIB_SEQUENCE_INFO_FILE_H_
#define SPLITFUSION_LIB_SEQUENCE_INFO_FILE_H_

#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/sequence/calibration.h"

namespace splitfusion {

/// Both cameras of a recording in the manner of BundleFusion and ScanNet.
/// Matrices are 4x4; the extrinsic ones map from the camera into a common
/// frame.
struct TwoCameras {
  cv::Size color_size;                            ///< Pixels.
  cv::Size depth_size;                            ///< Pixels.
  cv::Mat_<double> color_intrinsic;               ///< 3x3 or 4x4.
  cv::Mat_<double> depth_intrinsic;               ///< 3x3 or 4x4.
  Rigid3d color_extrinsic = Rigid3d::Identity();  ///< Common from colour.
  Rigid3d depth_extrinsic = Rigid3d::Identity();  ///< Common from depth.
  double depth_scale = 0;                         ///< Depth units in a metre.
};

/// Their calibration: that of registered images if the two are the same.
///
/// @throw InputError if a matrix is none of intrinsics; the places name them.
Calibration CalibrationOf(const std::string& color_place,
                          const std::string& depth_place,
                          const TwoCameras& cameras);

/// Reads `info.txt`: lines `m_colorWidth = 640` and so on.
///
/// @throw InputError on a missing file, and on keys that are missing or broken.
Calibration ReadInfoFile(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_INFO_FILE_H_
