#ifndef SPLITFUSION_LIB_SEQUENCE_SENS_FILE_H_
#define SPLITFUSION_LIB_SEQUENCE_SENS_FILE_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/info_file.h"

namespace splitfusion {

/// A recording of ScanNet, `.sens` of version 4: calibration, then per frame a
/// pose, a colour image (JPEG, PNG or raw) and a depth image (zlib or raw).
/// Thread-safe.
class SensFile {
 public:
  /// Reads the header and where the frames are.
  ///
  /// @throw InputError if it is missing, truncated, no such file, or has images
  ///     in another compression.
  explicit SensFile(const std::string& path);

  /// Calibration of both cameras.
  const TwoCameras& cameras() const { return cameras_; }

  /// Number of frames.
  int size() const { return static_cast<int>(frames_.size()); }

  /// World from camera of the i-th frame; none where it was not known.
  ///
  /// @throw InputError if it is no rigid motion.
  std::optional<Rigid3d> Pose(int i) const;

  /// Colour image of the i-th frame, HxW 8UC3, BGR.
  ///
  /// @throw InputError if it is broken.
  cv::Mat ReadColor(int i) const;

  /// Depth image of the i-th frame, HxW 16UC1.
  ///
  /// @throw InputError if it is broken.
  cv::Mat ReadDepth(int i) const;

 private:
  struct Place {
    cv::Mat_<double> world_from_camera;
    std::uint64_t color_offset = 0;
    std::uint64_t color_bytes = 0;
    std::uint64_t depth_offset = 0;
    std::uint64_t depth_bytes = 0;
  };
  class Stream;

  void ReadHeader(Stream* stream);
  void ReadFrames(Stream* stream);
  /// "FILE: frame I".
  std::string NameOf(int i) const;

  std::string path_;
  TwoCameras cameras_;
  int color_compression_ = 0;
  int depth_compression_ = 0;
  std::vector<Place> frames_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_SENS_FILE_H_
