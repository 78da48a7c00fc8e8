#ifndef SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_
#define SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_

#include <opencv2/core.hpp>
#include <string>

namespace splitfusion {

/// Reads a colour image (png, jpg, ...) as HxW 8UC3, BGR.
///
/// @throw InputError if the file is missing, truncated or not an image.
cv::Mat ReadColorImage(const std::string& path);

/// Reads a depth image, a 16-bit PNG of one channel, as HxW 16UC1.
///
/// @throw InputError if the file is missing, truncated, or not 16 bit.
cv::Mat ReadDepthImage(const std::string& path);

/// Reads a label or mask image, 8 or 16 bit, one channel, as HxW 16UC1.
///
/// @throw InputError if the file is missing, truncated, or has channels.
cv::Mat ReadLabelImage(const std::string& path);

/// "640x480".
std::string ToString(cv::Size size);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_IMAGE_FILE_H_
