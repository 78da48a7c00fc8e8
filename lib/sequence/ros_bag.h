#ifndef SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_
#define SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/calibration.h"

namespace splitfusion {

/// Images and cameras of a file of ROS 1, `.bag`. The headers of ROS stay out
/// of this one. Thread-safe.
class RosBag {
 public:
  virtual ~RosBag() = default;

  /// Names of the topics that have images, `sensor_msgs/Image` or
  /// `CompressedImage`, in alphabetical order.
  virtual std::vector<std::string> ImageTopics() const = 0;

  /// Whether there are messages `sensor_msgs/CameraInfo` of a topic.
  virtual bool HasCamera(const std::string& topic) const = 0;

  /// Time stamps of the images of topics, seconds: one row a topic.
  ///
  /// @throw InputError if one cannot be read.
  virtual std::vector<std::vector<double>> Times(
      const std::vector<std::string>& topics) const = 0;

  /// The i-th image of a topic as it is: colour as HxW 8UC3, BGR; depth as HxW
  /// 16UC1, millimetres, or 32FC1, metres.
  ///
  /// @throw InputError if it is broken or of an encoding that is not known.
  virtual cv::Mat Image(const std::string& topic, int i) const = 0;

  /// Intrinsics and lens of the first CameraInfo of a topic; no depth scale.
  ///
  /// @throw InputError if it is broken, or has distortion of another model than
  ///     LensDistortion.
  virtual Calibration Camera(const std::string& topic) const = 0;
};

/// Opens a bag of version 2.0, compressed or not.
///
/// @throw InputError if it is missing, truncated, no such file, encrypted or
///     has no index, or if this build lacks librosbag-storage.
std::unique_ptr<RosBag> OpenRosBag(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_ROS_BAG_H_
