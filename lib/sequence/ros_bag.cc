#include "splitfusion/lib/sequence/ros_bag.h"

#include <console_bridge/console.h>
#include <ros/exception.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/internal/ros_bag_check.h"

namespace splitfusion {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr std::uint32_t kMaxRosSide = 20000;  // Pixels.

/// As IStream, which takes the memory of an array before it looks whether the
/// message is that long.
class CheckedStream : public ros::serialization::IStream {
 public:
  explicit CheckedStream(std::vector<std::uint8_t>* bytes)
      : IStream(bytes->data(), static_cast<std::uint32_t>(bytes->size())) {}

  template <typename Value>
  void next(Value& value) {
    ros::serialization::deserialize(*this, value);
  }

  template <typename Value, typename Allocator>
  void next(std::vector<Value, Allocator>& values) {
    std::uint32_t count = 0;
    std::memcpy(&count, IStream(*this).advance(sizeof(count)), sizeof(count));
    if (count > (getLength() - sizeof(count)) / sizeof(Value)) {
      ros::serialization::throwStreamOverrun();
    }
    ros::serialization::deserialize(*this, values);
  }
};

template <typename Message>
bool IsA(const std::string& type) {
  return type == ros::message_traits::DataType<Message>::value();
}

/// How an encoding becomes an image.
struct RosEncoding {
  int type;        // Of its pixels.
  int conversion;  // Of cv::cvtColor(); < 0: none.
};

const std::map<std::string, RosEncoding>& RosEncodings() {
  static const std::map<std::string, RosEncoding> known = {
      {encodings::RGB8, {CV_8UC3, cv::COLOR_RGB2BGR}},
      {encodings::BGR8, {CV_8UC3, -1}},
      {encodings::RGBA8, {CV_8UC4, cv::COLOR_RGBA2BGR}},
      {encodings::BGRA8, {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {encodings::MONO8, {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {encodings::TYPE_8UC1, {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {encodings::TYPE_8UC3, {CV_8UC3, -1}},
      {encodings::TYPE_16UC1, {CV_16UC1, -1}},
      {encodings::MONO16, {CV_16UC1, -1}},
      {encodings::TYPE_32FC1, {CV_32FC1, -1}}};
  return known;
}

cv::Mat ImageOf(const std::string& place, sensor_msgs::Image message) {
  const auto found = RosEncodings().find(message.encoding);
  if (found == RosEncodings().end() || message.is_bigendian != 0) {
    throw InputError(
        place + ": encoding '" + message.encoding +
        "': expected rgb8, bgr8, mono8, 16UC1 or 32FC1, little-endian");
  }
  const RosEncoding& encoding = found->second;
  const std::uint32_t width = message.width;
  const std::uint32_t height = message.height;
  if (width < 1 || height < 1 || width > kMaxRosSide || height > kMaxRosSide ||
      message.step < width * CV_ELEM_SIZE(encoding.type) ||
      message.data.size() < std::size_t{message.step} * height) {
    throw InputError(place + ": image of " +
                     std::to_string(message.data.size()) + " bytes: expected " +
                     std::to_string(width) + "x" + std::to_string(height) +
                     " " + message.encoding);
  }
  const cv::Mat raw(static_cast<int>(height), static_cast<int>(width),
                    encoding.type, message.data.data(), message.step);
  if (encoding.conversion < 0) return raw.clone();
  cv::Mat image;
  cv::cvtColor(raw, image, encoding.conversion);
  return image;
}

/// What compressed_depth_image_transport puts before an image: metres are
/// a / (value - b), unless the image is of millimetres.
struct DepthConfiguration {
  std::int32_t kind = 0;
  float a = 0;
  float b = 0;
};

/// Metres, HxW 32FC1, of what that package makes of 32FC1; 0: none.
cv::Mat DepthOfInverse(const std::string& place, const cv::Mat& inverse,
                       const DepthConfiguration& by) {
  if (inverse.type() != CV_16UC1 || !(by.a > 0) || !std::isfinite(by.a) ||
      !std::isfinite(by.b)) {
    throw InputError(place + ": 32FC1; compressedDepth with " +
                     NumberText(by.a) + " and " + NumberText(by.b) +
                     ": expected an image of 16 bit, a number > 0 and another");
  }
  cv::Mat_<float> depth(inverse.size(), 0);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float value = inverse.at<std::uint16_t>(v, u);
      if (value > 0 && value > by.b) depth(v, u) = by.a / (value - by.b);
    }
  }
  return std::move(depth);
}

cv::Mat DepthOf(const std::string& place,
                sensor_msgs::CompressedImage message) {
  if (message.format.find("rvl") != std::string::npos) {
    throw InputError(place + ": '" + message.format +
                     "': expected compressedDepth by png");
  }
  DepthConfiguration configuration;
  const std::size_t size = std::min(sizeof(configuration), message.data.size());
  std::copy_n(message.data.begin(), size,
              reinterpret_cast<std::uint8_t*>(&configuration));
  message.data.erase(message.data.begin(),
                     message.data.begin() + static_cast<std::ptrdiff_t>(size));
  const cv::Mat image = DecodeImage(place, message.data, cv::IMREAD_UNCHANGED);
  if (message.format.rfind(encodings::TYPE_32FC1, 0) != 0) return image;
  return DepthOfInverse(place, image, configuration);
}

cv::Mat ImageOf(const std::string& place,
                sensor_msgs::CompressedImage message) {
  if (message.format.find("compressedDepth") != std::string::npos) {
    return DepthOf(place, std::move(message));
  }
  return DecodeImage(place, message.data, cv::IMREAD_COLOR);
}

Calibration CalibrationOf(const std::string& place,
                          const sensor_msgs::CameraInfo& message) {
  if (message.width > kMaxRosSide || message.height > kMaxRosSide) {
    throw InputError(place + ": " + std::to_string(message.width) + "x" +
                     std::to_string(message.height) +
                     " pixels: expected 20000 at most");
  }
  Calibration result;
  result.camera.width = static_cast<int>(message.width);
  result.camera.height = static_cast<int>(message.height);
  result.lens = MakeLensDistortion(place, message.distortion_model, message.D);
  cv::Mat_<double> matrix(3, 3);
  std::copy(message.K.begin(), message.K.end(), matrix.begin());
  SetIntrinsics(place, matrix, &result.camera);
  return result;
}

/// A bag that librosbag-storage reads.
class StoredRosBag : public RosBag {
 public:
  explicit StoredRosBag(const std::string& path) : path_(path) {
    CheckRosBag(path);
    // What goes wrong is in the exceptions.
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
    Locked([&] {
      bag_ = std::make_unique<rosbag::Bag>(path);
      ForEachMessage([&](const rosbag::MessageInstance& message) {
        topics_[message.getTopic()].push_back(message);
      });
    });
  }

  std::vector<std::string> ImageTopics() const override {
    std::vector<std::string> names;
    for (const auto& [name, messages] : topics_) {
      if (!HasCamera(name)) names.push_back(name);
    }
    return names;
  }

  bool HasCamera(const std::string& topic) const override {
    const auto found = topics_.find(topic);
    return found != topics_.end() &&
           IsA<sensor_msgs::CameraInfo>(found->second.front().getDataType());
  }

  std::vector<std::vector<double>> Times(
      const std::vector<std::string>& topics) const override {
    std::vector<std::vector<double>> times(topics.size());
    Locked([&] {
      // In the order of time, so that no chunk is decompressed twice.
      ForEachMessage([&](const rosbag::MessageInstance& message) {
        const std::string& topic = message.getTopic();
        const auto found = std::find(topics.begin(), topics.end(), topic);
        if (found == topics.end()) return;
        std::vector<double>& row = times[found - topics.begin()];
        const std::string place = PlaceOf(topic, row.size());
        const auto header = Parse<std_msgs::Header>(place, BytesOf(message));
        row.push_back(header.stamp.toSec());
      });
    });
    return times;
  }

  cv::Mat Image(const std::string& topic, int i) const override {
    const std::string place = PlaceOf(topic, i);
    if (IsA<sensor_msgs::Image>(topics_.at(topic).at(i).getDataType())) {
      return ImageOf(place, Read<sensor_msgs::Image>(topic, i));
    }
    return ImageOf(place, Read<sensor_msgs::CompressedImage>(topic, i));
  }

  Calibration Camera(const std::string& topic) const override {
    return CalibrationOf(PlaceOf(topic, 0),
                         Read<sensor_msgs::CameraInfo>(topic, 0));
  }

 private:
  static bool IsRead(const rosbag::ConnectionInfo* connection) {
    const std::string& type = connection->datatype;
    return IsA<sensor_msgs::Image>(type) ||
           IsA<sensor_msgs::CompressedImage>(type) ||
           IsA<sensor_msgs::CameraInfo>(type);
  }

  static std::vector<std::uint8_t> BytesOf(
      const rosbag::MessageInstance& message) {
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(
        bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    return bytes;
  }

  /// A message, or what it begins with.
  template <typename Message>
  static Message Parse(const std::string& place,
                       std::vector<std::uint8_t> bytes) {
    try {
      CheckedStream stream(&bytes);
      Message message;
      ros::serialization::deserialize(stream, message);
      return message;
    } catch (const ros::serialization::StreamOverrunException&) {
      throw InputError(place + ": is truncated");
    }
  }

  template <typename Message>
  Message Read(const std::string& topic, int i) const {
    std::vector<std::uint8_t> bytes;
    Locked([&] { bytes = BytesOf(topics_.at(topic).at(i)); });
    return Parse<Message>(PlaceOf(topic, i), std::move(bytes));
  }

  /// Calls something for every message that IsRead(), ordered by time.
  template <typename Action>
  void ForEachMessage(const Action& action) const {
    rosbag::View view(*bag_, IsRead, ros::Time());
    for (const rosbag::MessageInstance& message : view) action(message);
  }

  /// The library uses buffers of the bag even to read.
  template <typename Action>
  void Locked(const Action& action) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      action();
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw InputError(path_ + ": " + error.what());
    }
  }

  std::string PlaceOf(const std::string& topic, std::size_t i) const {
    return path_ + ": " + topic + ", message " + std::to_string(i);
  }

  std::string path_;
  mutable std::mutex mutex_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::map<std::string, std::vector<rosbag::MessageInstance>> topics_;
};

}  // namespace

std::unique_ptr<RosBag> OpenRosBag(const std::string& path) {
  return std::make_unique<StoredRosBag>(path);
}

}  // namespace splitfusion
