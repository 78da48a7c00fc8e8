#include "splitfusion/lib/sequence/image_file.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes ReadBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// The decoders fill a truncated picture with grey and only print a warning:
/// look for the end marker of the format first.
bool LooksTruncated(const Bytes& bytes) {
  const auto contains = [&](const Bytes& marker) {
    return std::search(bytes.rbegin(), bytes.rend(), marker.rbegin(),
                       marker.rend()) != bytes.rend();
  };
  if (bytes.size() < 12) return true;
  if (bytes[0] == 0xff && bytes[1] == 0xd8) return !contains({0xff, 0xd9});
  if (bytes[0] == 0x89 && bytes[1] == 'P') {
    return !contains({'I', 'E', 'N', 'D'});
  }
  return false;
}

cv::Mat Decode(const std::string& path, int flags) {
  const Bytes bytes = ReadBytes(path);
  cv::Mat image;
  if (!LooksTruncated(bytes)) {
    try {
      image = cv::imdecode(bytes, flags);
    } catch (const cv::Exception&) {
      image.release();
    }
  }
  if (image.empty()) {
    throw InputError(path + ": " + std::to_string(bytes.size()) +
                     " bytes that are no image or a truncated one: expected a "
                     "complete png or jpg");
  }
  return image;
}

[[noreturn]] void ThrowFormat(const std::string& path, const cv::Mat& image,
                              const std::string& expected) {
  throw InputError(
      path + ": image of " + std::to_string(8 * image.elemSize1()) + " bit, " +
      std::to_string(image.channels()) + " channel(s): expected " + expected);
}

}  // namespace

cv::Mat ReadColorImage(const std::string& path) {
  return Decode(path, cv::IMREAD_COLOR);
}

cv::Mat ReadDepthImage(const std::string& path) {
  cv::Mat image = Decode(path, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_16UC1) {
    ThrowFormat(path, image, "a depth image of 16 bit, 1 channel");
  }
  return image;
}

cv::Mat ReadLabelImage(const std::string& path) {
  cv::Mat image = Decode(path, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_16UC1 && image.type() != CV_8UC1) {
    ThrowFormat(path, image, "a label image of 8 or 16 bit, 1 channel");
  }
  cv::Mat labels;
  image.convertTo(labels, CV_16U);
  return labels;
}

std::string ToString(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace splitfusion
