#include "splitfusion/lib/sequence/sens_file.h"

#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

constexpr std::uint32_t kSensVersion = 4;
constexpr std::uint32_t kMaxSensSide = 10000;   // Pixels.
constexpr std::uint64_t kMaxSensorName = 4096;  // Bytes.

enum ColorCompression { kColorRaw = 0, kColorPng = 1, kColorJpeg = 2 };
enum DepthCompression { kDepthRaw = 0, kDepthZlib = 1 };

}  // namespace

/// Little-endian numbers, one after the other.
class SensFile::Stream {
 public:
  explicit Stream(const std::string& path) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
      throw InputError(path + ": no such file: expected a .sens of ScanNet");
    }
    size_ = std::filesystem::file_size(path, error);
    stream_.open(path, std::ios::binary);
    if (error || !stream_) throw InputError(path + ": cannot be opened");
  }

  template <typename Number>
  Number Read() {
    Number value = 0;
    Need(sizeof(value));
    stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
    at_ += sizeof(value);
    return value;
  }

  cv::Mat_<double> ReadMatrix() {
    cv::Mat_<double> matrix(4, 4);
    for (double& element : matrix) element = Read<float>();
    return matrix;
  }

  std::vector<std::uint8_t> Bytes(std::uint64_t offset, std::uint64_t count) {
    std::vector<std::uint8_t> bytes(count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(bytes.data()),
                 static_cast<std::streamsize>(count));
    if (static_cast<std::uint64_t>(stream_.gcount()) != count) Fail();
    return bytes;
  }

  /// Goes past some bytes; returns where they begin.
  std::uint64_t Skip(std::uint64_t count) {
    Need(count);
    const std::uint64_t begin = at_;
    at_ += count;
    stream_.seekg(static_cast<std::streamoff>(at_));
    return begin;
  }

  /// @throw InputError unless so many bytes are left.
  void Need(std::uint64_t count) const {
    if (count > size_ - at_) Fail();
  }

  [[noreturn]] void Fail() const {
    throw InputError(path_ + ": " + std::to_string(size_) +
                     " bytes that are no .sens file of ScanNet, version 4, or "
                     "a truncated one");
  }

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t at_ = 0;
};

SensFile::SensFile(const std::string& path) : path_(path) {
  Stream stream(path);
  ReadHeader(&stream);
  ReadFrames(&stream);
}

void SensFile::ReadHeader(Stream* stream) {
  if (stream->Read<std::uint32_t>() != kSensVersion) stream->Fail();
  const auto name = stream->Read<std::uint64_t>();  // Of the sensor.
  if (name > kMaxSensorName) stream->Fail();
  stream->Skip(name);
  cameras_.color_intrinsic = stream->ReadMatrix();
  const cv::Mat_<double> color_extrinsic = stream->ReadMatrix();
  cameras_.depth_intrinsic = stream->ReadMatrix();
  const cv::Mat_<double> depth_extrinsic = stream->ReadMatrix();
  cameras_.color_extrinsic =
      KnownRigidMotion(path_ + ": pose of the colour camera", color_extrinsic);
  cameras_.depth_extrinsic =
      KnownRigidMotion(path_ + ": pose of the depth camera", depth_extrinsic);
  color_compression_ = stream->Read<std::int32_t>();
  depth_compression_ = stream->Read<std::int32_t>();
  if (color_compression_ < kColorRaw || color_compression_ > kColorJpeg ||
      depth_compression_ < kDepthRaw || depth_compression_ > kDepthZlib) {
    throw InputError(path_ + ": compression " +
                     std::to_string(color_compression_) + " of colour, " +
                     std::to_string(depth_compression_) +
                     " of depth: expected jpeg, png or raw (2, 1, 0), and zlib "
                     "or raw (1, 0)");
  }
  const auto read_size = [&] {
    const auto width = stream->Read<std::uint32_t>();
    const auto height = stream->Read<std::uint32_t>();
    if (width < 1 || height < 1 || width > kMaxSensSide ||
        height > kMaxSensSide) {
      stream->Fail();
    }
    return cv::Size(static_cast<int>(width), static_cast<int>(height));
  };
  cameras_.color_size = read_size();
  cameras_.depth_size = read_size();
  cameras_.depth_scale = stream->Read<float>();
  if (std::isfinite(cameras_.depth_scale) && cameras_.depth_scale > 0) return;
  throw InputError(path_ + ": depth shift " + NumberText(cameras_.depth_scale) +
                   ": expected depth units in a metre, a number > 0");
}

void SensFile::ReadFrames(Stream* stream) {
  const auto count = stream->Read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    Place& place = frames_.emplace_back();
    place.world_from_camera = stream->ReadMatrix();
    stream->Skip(2 * sizeof(std::uint64_t));  // Time stamps, often all 0.
    place.color_bytes = stream->Read<std::uint64_t>();
    place.depth_bytes = stream->Read<std::uint64_t>();
    place.color_offset = stream->Skip(place.color_bytes);
    place.depth_offset = stream->Skip(place.depth_bytes);
  }
  if (frames_.empty()) throw InputError(path_ + ": 0 frames: expected some");
}

std::string SensFile::NameOf(int i) const {
  return path_ + ": frame " + std::to_string(i);
}

std::optional<Rigid3d> SensFile::Pose(int i) const {
  return RigidMotion(NameOf(i), frames_.at(i).world_from_camera);
}

cv::Mat SensFile::ReadColor(int i) const {
  const Place& place = frames_.at(i);
  std::vector<std::uint8_t> bytes =
      Stream(path_).Bytes(place.color_offset, place.color_bytes);
  const cv::Size size = cameras_.color_size;
  cv::Mat color;
  if (color_compression_ != kColorRaw) {
    color = DecodeImage(NameOf(i), bytes,
                        cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } else if (bytes.size() == 3 * static_cast<std::size_t>(size.area())) {
    cv::cvtColor(cv::Mat(size, CV_8UC3, bytes.data()), color,
                 cv::COLOR_RGB2BGR);
  }
  if (color.size() == size) return color;
  throw InputError(NameOf(i) + ": colour of " + ToString(color.size()) +
                   ": expected " + ToString(size));
}

cv::Mat SensFile::ReadDepth(int i) const {
  const Place& place = frames_.at(i);
  const std::vector<std::uint8_t> bytes =
      Stream(path_).Bytes(place.depth_offset, place.depth_bytes);
  cv::Mat_<std::uint16_t> depth(cameras_.depth_size);
  const uLongf expected = depth.total() * sizeof(std::uint16_t);
  uLongf got = expected;
  bool good = false;
  if (depth_compression_ == kDepthZlib) {
    good = uncompress(depth.data, &got, bytes.data(), bytes.size()) == Z_OK;
  } else if (bytes.size() == expected) {
    std::memcpy(depth.data, bytes.data(), expected);
    good = true;
  }
  if (good && got == expected) return std::move(depth);
  throw InputError(NameOf(i) + ": depth of " + std::to_string(bytes.size()) +
                   " bytes that are broken: expected an image of " +
                   ToString(cameras_.depth_size));
}

}  // namespace splitfusion
