#include "splitfusion/lib/sequence/image_header.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxPixels = 100000000;
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 30;

const std::string kPngSignature = "\x89PNG\r\n\x1a\n";
const std::string kPngEnd = "IEND";
const std::string kJpegStart = "\xff\xd8";
const std::string kJpegEnd = "\xff\xd9";

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// The file at a path, a regular one, opened.
class ImageBytes {
 public:
  explicit ImageBytes(const std::string& path) : path_(path) {
    std::error_code error;
    // Asked before it is opened: opening a pipe waits for a writer.
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) Fail("cannot be opened (no such file)");
    if (!fs::is_regular_file(status)) {
      Fail("is no regular file: expected an image");
    }
    size_ = fs::file_size(path, error);
    stream_.open(path, std::ios::binary);
    if (error || !stream_) Fail("cannot be opened");
    if (size_ > kMaxBytes) Fail("is larger than 1 GiB: expected an image");
  }

  std::uintmax_t size() const { return size_; }

  /// Bytes from an offset, fewer where the file ends.
  std::string Read(std::uintmax_t offset, std::size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(stream_.gcount()));
    return bytes;
  }

  /// Whether the end marker comes after `offset`: almost always within the last
  /// `tail` bytes, but a file may go on after its image.
  bool HasAfter(std::uintmax_t offset, const std::string& marker,
                std::size_t tail) {
    const auto holds = [&](const std::string& bytes) {
      return bytes.find(marker) != std::string::npos;
    };
    if (offset >= size_) return false;
    const std::uintmax_t rest = size_ - offset;
    if (rest <= tail) return holds(Read(offset, rest));
    return holds(Read(size_ - tail, tail)) || holds(Read(offset, rest));
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(path_ + ": " + what);
  }

  [[noreturn]] void FailAsNoImage() const {
    Fail(std::to_string(size_) +
         " bytes that are no image or a truncated one: expected a complete png "
         "or jpg");
  }

 private:
  std::string path_;
  std::ifstream stream_;
  std::uintmax_t size_ = 0;
};

/// Big-endian number of `count` bytes.
std::int64_t NumberAt(const std::string& bytes, std::size_t at, int count) {
  std::int64_t value = 0;
  for (int k = 0; k < count; ++k) {
    value = value * 256 + static_cast<unsigned char>(bytes.at(at + k));
  }
  return value;
}

ImageHeader MakeHeader(const ImageBytes& file, std::int64_t width,
                       std::int64_t height) {
  if (width < 1 || height < 1) file.FailAsNoImage();
  if (width > kMaxPixels || height > kMaxPixels ||
      width * height > kMaxPixels) {
    file.Fail("image of " + std::to_string(width) + "x" +
              std::to_string(height) + ": expected at most 100 million pixels");
  }
  ImageHeader header;
  header.size = cv::Size(static_cast<int>(width), static_cast<int>(height));
  return header;
}

/// Channels as decoded, by the colour type of a PNG.
int PngChannels(std::int64_t color_type) {
  if (color_type == 0) return 1;                      // Grey.
  return color_type == 4 || color_type == 6 ? 4 : 3;  // With alpha.
}

ImageHeader ReadPng(ImageBytes* file) {
  // Signature, length and name of the first chunk, its 13 bytes, check sum.
  constexpr std::size_t kHeadBytes = 33;
  const std::string head = file->Read(0, kHeadBytes);
  if (head.size() < kHeadBytes || head.compare(12, 4, "IHDR") != 0 ||
      !file->HasAfter(kHeadBytes, kPngEnd, 12)) {
    file->FailAsNoImage();
  }
  ImageHeader header =
      MakeHeader(*file, NumberAt(head, 16, 4), NumberAt(head, 20, 4));
  header.bits = NumberAt(head, 24, 1) == 16 ? 16 : 8;
  header.channels = PngChannels(NumberAt(head, 25, 1));
  return header;
}

/// Whether a JPEG marker begins a frame, whose header has the size.
bool BeginsFrame(std::int64_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 &&
         marker != 0xcc;
}

ImageHeader ReadJpeg(ImageBytes* file) {
  constexpr std::int64_t kScan = 0xda;
  constexpr int kMaxSegments = 10000;
  ImageHeader header;
  std::uintmax_t at = kJpegStart.size();
  for (int k = 0;; ++k) {
    // Marker, length, and of a frame: precision, height, width, channels.
    const std::string segment = file->Read(at, 10);
    if (k == kMaxSegments || segment.size() < 10 ||
        NumberAt(segment, 0, 1) != 0xff) {
      file->FailAsNoImage();
    }
    const std::int64_t marker = NumberAt(segment, 1, 1);
    if (marker == 0xff) {  // A byte to fill.
      ++at;
      continue;
    }
    at += 2 + static_cast<std::uintmax_t>(NumberAt(segment, 2, 2));
    if (marker == kScan) break;
    if (!BeginsFrame(marker)) continue;
    header =
        MakeHeader(*file, NumberAt(segment, 7, 2), NumberAt(segment, 5, 2));
    header.channels = NumberAt(segment, 9, 1) == 1 ? 1 : 3;
  }
  // Before the scan there may be an end marker, too: that of a thumbnail.
  if (header.size.empty() || !file->HasAfter(at, kJpegEnd, 2)) {
    file->FailAsNoImage();
  }
  return header;
}

/// Whether the name promises a format that is known here.
bool IsNamedPngOrJpeg(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

}  // namespace

std::optional<ImageHeader> ReadImageHeader(const std::string& path) {
  ImageBytes file(path);
  const std::string head = file.Read(0, kPngSignature.size());
  if (StartsWith(head, kPngSignature)) return ReadPng(&file);
  if (StartsWith(head, kJpegStart)) return ReadJpeg(&file);
  if (file.size() == 0 || IsNamedPngOrJpeg(path)) file.FailAsNoImage();
  return std::nullopt;
}

}  // namespace splitfusion
