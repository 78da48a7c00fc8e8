#include "splitfusion/lib/sequence/ros_messages.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

constexpr std::uint32_t kMaxRosSide = 20000;  // Pixels.

/// The fields of a serialized message, one after the other.
class MessageReader {
 public:
  MessageReader(const std::string& place, const std::string& bytes)
      : place_(place), bytes_(bytes) {}

  template <typename Number>
  Number Read() {
    Number number = 0;
    std::memcpy(&number, Take(sizeof(number)), sizeof(number));
    return number;
  }

  /// What follows its length.
  std::string ReadText() {
    const auto size = Read<std::uint32_t>();
    return {Take(size), size};
  }

  std::vector<double> ReadNumbers(std::size_t count) {
    const char* data = Take(count * sizeof(double));
    std::vector<double> numbers(count);
    std::memcpy(numbers.data(), data, count * sizeof(double));
    return numbers;
  }

  /// Sequence number and time stamp; returns the time, seconds.
  double ReadTime() {
    Read<std::uint32_t>();
    const auto seconds = Read<std::uint32_t>();
    const auto nanoseconds = Read<std::uint32_t>();
    return seconds + 1e-9 * nanoseconds;
  }

  /// Goes past sequence number, time stamp and frame.
  void SkipHeader() {
    ReadTime();
    ReadText();
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(place_ + ": " + what);
  }

 private:
  const char* Take(std::size_t count) {
    if (count > bytes_.size() - at_) Fail("is truncated");
    const char* data = bytes_.data() + at_;
    at_ += count;
    return data;
  }

  const std::string& place_;
  const std::string& bytes_;
  std::size_t at_ = 0;
};

/// How an encoding becomes an image.
struct Encoding {
  int type;        // Of its pixels.
  int conversion;  // Of cv::cvtColor(); < 0: none.
};

const std::map<std::string, Encoding>& Encodings() {
  static const std::map<std::string, Encoding> encodings = {
      {"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
      {"bgr8", {CV_8UC3, -1}},
      {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGR}},
      {"bgra8", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"mono8", {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {"8UC1", {CV_8UC1, cv::COLOR_GRAY2BGR}},
      {"8UC3", {CV_8UC3, -1}},
      {"16UC1", {CV_16UC1, -1}},
      {"mono16", {CV_16UC1, -1}},
      {"32FC1", {CV_32FC1, -1}}};
  return encodings;
}

cv::Mat RawImage(MessageReader* reader) {
  const auto height = reader->Read<std::uint32_t>();
  const auto width = reader->Read<std::uint32_t>();
  const std::string name = reader->ReadText();
  const auto is_bigendian = reader->Read<std::uint8_t>();
  const auto step = reader->Read<std::uint32_t>();
  std::string data = reader->ReadText();
  const auto found = Encodings().find(name);
  if (found == Encodings().end() || is_bigendian != 0) {
    reader->Fail(
        "encoding '" + name +
        "': expected rgb8, bgr8, mono8, 16UC1 or 32FC1, little-endian");
  }
  const Encoding& encoding = found->second;
  const std::size_t row = std::size_t{width} * CV_ELEM_SIZE(encoding.type);
  if (width < 1 || height < 1 || width > kMaxRosSide || height > kMaxRosSide ||
      step < row || data.size() < std::size_t{step} * height) {
    reader->Fail("image of " + std::to_string(data.size()) +
                 " bytes: expected " + std::to_string(width) + "x" +
                 std::to_string(height) + " " + name);
  }
  const cv::Mat raw(static_cast<int>(height), static_cast<int>(width),
                    encoding.type, data.data(), step);
  cv::Mat image;
  if (encoding.conversion < 0) return raw.clone();
  cv::cvtColor(raw, image, encoding.conversion);
  return image;
}

cv::Mat CompressedImage(const std::string& place, MessageReader* reader) {
  const std::string format = reader->ReadText();
  std::string data = reader->ReadText();
  const bool is_depth = format.find("compressedDepth") != std::string::npos;
  if (is_depth) {
    // A configuration is before the PNG: what it is for, two numbers.
    constexpr std::size_t kConfiguration = 12;
    if (format.rfind("32FC1", 0) == 0) {
      reader->Fail("'" + format + "': expected 16UC1; compressedDepth");
    }
    data.erase(0, std::min(kConfiguration, data.size()));
  }
  const int flags = is_depth ? cv::IMREAD_UNCHANGED : cv::IMREAD_COLOR;
  return DecodeImage(place, {data.begin(), data.end()}, flags);
}

}  // namespace

double RosTime(const std::string& place, const std::string& message) {
  return MessageReader(place, message).ReadTime();
}

cv::Mat RosImage(const std::string& place, const std::string& type,
                 const std::string& message) {
  MessageReader reader(place, message);
  reader.SkipHeader();
  if (type == kRosImage) return RawImage(&reader);
  return CompressedImage(place, &reader);
}

Calibration RosCamera(const std::string& place, const std::string& message) {
  MessageReader reader(place, message);
  reader.SkipHeader();
  Calibration result;
  const auto height = reader.Read<std::uint32_t>();
  const auto width = reader.Read<std::uint32_t>();
  if (width > kMaxRosSide || height > kMaxRosSide) reader.Fail("wrong size");
  result.camera.width = static_cast<int>(width);
  result.camera.height = static_cast<int>(height);
  const std::string model = reader.ReadText();
  const auto count = reader.Read<std::uint32_t>();
  result.lens = MakeLensDistortion(place, model, reader.ReadNumbers(count));
  std::vector<double> k = reader.ReadNumbers(9);
  SetIntrinsics(place, cv::Mat_<double>(3, 3, k.data()), &result.camera);
  return result;
}

}  // namespace splitfusion
