#include "splitfusion/lib/report/disk_space.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

// Measured on sequences of 320x240 and 640x480, and rounded down: the check is
// for disks on which a run cannot end.
constexpr std::uint64_t kModelBytesPerPixel = 200;
constexpr std::uint64_t kCheckpointBytesPerPixel = 190;
constexpr std::uint64_t kPictureBytesPerPixel = 4;
constexpr std::uint64_t kBytesPerFrame = 20000;

constexpr std::uint64_t kMegabyte = 1000000;

}  // namespace

std::uint64_t EstimatedBytes(const RunExtent& extent) {
  const std::uint64_t pixels = extent.pixels;
  const std::uint64_t frames = extent.frames;
  const std::uint64_t pictures =
      extent.pictures_every > 0 ? frames / extent.pictures_every + 1 : 0;
  const std::uint64_t states = extent.checkpoints ? 1 : 0;
  return pixels * (kModelBytesPerPixel + states * kCheckpointBytesPerPixel +
                   pictures * kPictureBytesPerPixel) +
         frames * kBytesPerFrame;
}

void CheckDiskSpace(const std::string& folder, std::uint64_t bytes) {
  std::error_code error;
  const auto space = std::filesystem::space(folder, error);
  if (error || space.available >= bytes) return;
  throw InputError(folder + ": the disk has " +
                   std::to_string(space.available / kMegabyte) +
                   " MB left: expected " +
                   std::to_string((bytes + kMegabyte - 1) / kMegabyte) +
                   " MB at least for this run");
}

}  // namespace splitfusion
