#include "splitfusion/lib/sequence/image_file.h"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

std::vector<std::uint8_t> ReadBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Kind of the first chunk of a PNG that is damaged, as its checksum tells, or
/// missing; empty if none is, and of other files. The decoder would notice, but
/// say so in lines of its own.
std::string DamagedChunk(const std::vector<std::uint8_t>& bytes) {
  const std::string signature = "\x89PNG\r\n\x1a\n", end = "IEND";
  if (bytes.size() < signature.size() ||
      std::memcmp(bytes.data(), signature.data(), signature.size()) != 0) {
    return "";
  }
  const auto number = [&](std::size_t at) {  // Most significant byte first.
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | bytes[i];
    return value;
  };
  constexpr std::size_t kAround = 12;  // Format: length, kind and checksum.
  std::size_t at = signature.size();
  while (at + kAround <= bytes.size()) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - kAround) return end;
    const std::uint8_t* content = bytes.data() + at + 4;
    const std::string kind(content, content + 4);
    // Chunks that images can do without are in small letters.
    const bool needed = kind[0] >= 'A' && kind[0] <= 'Z';
    const uLong sum = crc32(0, content, static_cast<uInt>(4 + length));
    if (needed && sum != number(at + 8 + length)) return kind;
    if (kind == end) return "";
    at += kAround + length;
  }
  return end;
}

cv::Mat Decode(const std::string& path, int flags) {
  ReadImageHeader(path);
  return DecodeImage(path, ReadBytes(path), flags);
}

[[noreturn]] void ThrowFormat(const std::string& path,
                              const ImageHeader& header,
                              const std::string& expected) {
  throw InputError(path + ": image of " + std::to_string(header.bits) +
                   " bit, " + std::to_string(header.channels) +
                   " channel(s): expected " + expected);
}

/// @throw InputError unless it is a depth image.
void CheckIsDepth(const std::string& path, const ImageHeader& header) {
  const bool has_bits = header.bits == 16 || header.bits == 32;
  if (has_bits && header.channels == 1) return;
  ThrowFormat(path, header, "a depth image of 16 bit, 1 channel");
}

/// @throw InputError unless it is a label image.
void CheckIsLabel(const std::string& path, const ImageHeader& header) {
  if (header.channels == 1) return;
  ThrowFormat(path, header, "a label image of 8 or 16 bit, 1 channel");
}

ImageHeader HeaderOf(const cv::Mat& image) {
  return {image.size(), static_cast<int>(8 * image.elemSize1()),
          image.channels()};
}

}  // namespace

cv::Mat DecodeImage(const std::string& path,
                    const std::vector<std::uint8_t>& bytes, int flags) {
  const std::string damaged = DamagedChunk(bytes);
  if (!damaged.empty()) {
    throw InputError(path + ": " + std::to_string(bytes.size()) +
                     " bytes of a png whose chunk " + damaged +
                     " is damaged: expected a complete png or jpg");
  }
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) {
    throw InputError(path + ": " + std::to_string(bytes.size()) +
                     " bytes that are no image or a truncated one: expected a "
                     "complete png or jpg");
  }
  return image;
}

cv::Mat ReadColorImage(const std::string& path) {
  // The depth knows nothing of an orientation.
  return Decode(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
}

cv::Mat ReadDepthImage(const std::string& path) {
  cv::Mat image = Decode(path, cv::IMREAD_UNCHANGED);
  CheckIsDepth(path, HeaderOf(image));
  // Integers of 32 bit are refused as well: nothing says what they mean.
  if (image.depth() == CV_16U || image.depth() == CV_32F) return image;
  throw InputError(path +
                   ": image of signed integers: expected a depth image "
                   "of 16 bit, or of floating-point numbers");
}

cv::Mat ReadLabelImage(const std::string& path) {
  cv::Mat image = Decode(path, cv::IMREAD_UNCHANGED);
  CheckIsLabel(path, HeaderOf(image));
  cv::Mat labels;
  image.convertTo(labels, CV_16U);
  return labels;
}

std::optional<ImageHeader> ReadDepthHeader(const std::string& path) {
  const std::optional<ImageHeader> header = ReadImageHeader(path);
  if (header) CheckIsDepth(path, *header);
  return header;
}

std::optional<ImageHeader> ReadLabelHeader(const std::string& path) {
  const std::optional<ImageHeader> header = ReadImageHeader(path);
  if (header) CheckIsLabel(path, *header);
  return header;
}

std::string EncodeImage(const std::string& path, const cv::Mat& image,
                        const std::vector<int>& parameters) {
  if (image.empty()) throw InputError(path + ": no image to be written");
  const std::string extension = std::filesystem::path(path).extension();
  std::vector<std::uint8_t> bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(extension, image, bytes, parameters);
  } catch (const cv::Exception&) {
    // Too large for the format, or no format of that name.
  }
  if (!encoded) {
    throw InputError(path + ": " + ToString(image.size()) +
                     " pixels cannot be written as " + extension);
  }
  return {bytes.begin(), bytes.end()};
}

void WriteImage(const std::string& path, const cv::Mat& image,
                const std::vector<int>& parameters) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << EncodeImage(path, image, parameters);
  });
}

std::string ToString(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace splitfusion
