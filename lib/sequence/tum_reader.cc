#include "splitfusion/lib/sequence/tum_reader.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// The calibration file's values, each replaced by the option if given.
Calibration ResolveCalibration(const std::string& folder,
                               const TumReaderOptions& options) {
  const bool complete = options.camera && options.depth_scale > 0;
  std::optional<Calibration> file;
  if (!complete) file = FindCalibration(folder);
  if (!complete && !file) {
    throw InputError(folder +
                     ": neither calibration.txt nor camera.txt found: expected "
                     "one of them, or intrinsics and depth scale as options");
  }
  Calibration calibration = file.value_or(Calibration());
  if (options.camera) calibration.camera = *options.camera;
  if (options.depth_scale > 0) calibration.depth_scale = options.depth_scale;
  calibration.Check();
  return calibration;
}

std::vector<AssociatedFiles> SelectFrames(std::vector<AssociatedFiles> pairs,
                                          const TumReaderOptions& options) {
  const int count = static_cast<int>(pairs.size());
  CheckOption(
      options.first_frame < count, "first_frame", options.first_frame,
      "less than the " + std::to_string(count) + " frames of the sequence");
  pairs.erase(pairs.begin(), pairs.begin() + options.first_frame);
  if (options.max_frames > 0 &&
      options.max_frames < static_cast<int>(pairs.size())) {
    pairs.resize(options.max_frames);
  }
  return pairs;
}

}  // namespace

void TumReaderOptions::Check() const {
  CheckOption(first_frame >= 0, "first_frame", first_frame, "an index >= 0");
  CheckOption(max_frames >= 0, "max_frames", max_frames,
              "a number > 0, or 0 for all");
  CheckOption(
      std::isfinite(association_tolerance) && association_tolerance >= 0,
      "association_tolerance", association_tolerance, "seconds >= 0");
  CheckOption(std::isfinite(depth_scale) && depth_scale >= 0, "depth_scale",
              depth_scale, "units per metre > 0, or 0 for the file's");
  if (camera) camera->Check();
  depth_filter.Check();
}

TumReader::TumReader(const std::string& folder, TumReaderOptions options)
    : folder_(folder), options_(std::move(options)) {
  options_.Check();
  pairs_ = SelectFrames(
      FindAssociations(folder_, options_.association_tolerance), options_);
  calibration_ = ResolveCalibration(folder_, options_);
}

void TumReader::CheckSize(const std::string& path, const cv::Mat& image) const {
  const cv::Size expected(camera().width, camera().height);
  if (image.size() == expected) return;
  throw InputError(path + ": image of " + ToString(image.size()) +
                   ": expected " + ToString(expected) +
                   ", the size of the calibration");
}

std::string TumReader::Stem(int i) const {
  return fs::path(pairs_.at(i).depth.file).stem().string();
}

std::string TumReader::ColorStem(int i) const {
  return fs::path(pairs_.at(i).color.file).stem().string();
}

std::optional<Frame> TumReader::Next() {
  if (next_ >= size()) return std::nullopt;
  const AssociatedFiles& pair = pairs_[next_];
  const fs::path color_path = fs::path(folder_) / pair.color.file;
  const fs::path depth_path = fs::path(folder_) / pair.depth.file;
  Frame frame;
  frame.index = options_.first_frame + next_;
  frame.timestamp = pair.depth.timestamp;
  frame.stem = depth_path.stem().string();
  frame.color_stem = color_path.stem().string();
  frame.color = ReadColorImage(color_path.string());
  CheckSize(color_path.string(), frame.color);
  const cv::Mat raw = ReadDepthImage(depth_path.string());
  CheckSize(depth_path.string(), raw);
  frame.depth = FilterDepth(DepthInMetres(raw, calibration_.depth_scale),
                            options_.depth_filter);
  ++next_;
  return frame;
}

}  // namespace splitfusion
