#ifndef SPLITFUSION_LIB_SEQUENCE_ROS_MESSAGES_H_
#define SPLITFUSION_LIB_SEQUENCE_ROS_MESSAGES_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/sequence/calibration.h"

namespace splitfusion {

/// Type names of what is read of a bag.
constexpr const char* kRosImage = "sensor_msgs/Image";
/// The same as a PNG or JPEG.
constexpr const char* kRosCompressedImage = "sensor_msgs/CompressedImage";
/// Intrinsics.
constexpr const char* kRosCameraInfo = "sensor_msgs/CameraInfo";

/// Bytes at the beginning of a message that begins with a header, by which
/// RosTime() goes.
constexpr std::uint32_t kRosTimeBytes = 12;

/// Time stamp of such a message, seconds.
///
/// @throw InputError if it is truncated; `place` names it.
double RosTime(const std::string& place, const std::string& message);

/// An image of either type as it is: colour as HxW 8UC3, BGR; depth as HxW
/// 16UC1, millimetres, or 32FC1, metres.
///
/// @throw InputError if it is broken or of an encoding that is not known;
///     `place` names it.
cv::Mat RosImage(const std::string& place, const std::string& type,
                 const std::string& message);

/// Intrinsics and lens of a CameraInfo; no depth scale.
///
/// @throw InputError if it is broken, or has distortion of another model than
///     LensDistortion; `place` names it.
Calibration RosCamera(const std::string& place, const std::string& message);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_ROS_MESSAGES_H_
