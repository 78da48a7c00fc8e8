#ifndef SPLITFUSION_LIB_SEQUENCE_FRAME_H_
#define SPLITFUSION_LIB_SEQUENCE_FRAME_H_

#include <opencv2/core.hpp>
#include <string>

namespace splitfusion {

/// One RGB-D frame; colour and depth are registered and of equal size.
struct Frame {
  int index = 0;         ///< Position in the sequence, from 0.
  double timestamp = 0;  ///< Of the depth image, seconds.
  std::string stem;      ///< Depth file's name without folder and extension.
  std::string color_stem = {};  ///< The same of the colour file.
  cv::Mat color;                ///< HxW 8UC3, BGR.
  cv::Mat depth;                ///< HxW 32FC1, metres, 0 = no measurement.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_FRAME_H_
