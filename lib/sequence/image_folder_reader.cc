#include "splitfusion/lib/sequence/image_folder_reader.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Given poses are no farther from the first one, metres: a volume has a table
/// of the box of all that it holds.
constexpr double kMaxWay = 200;

std::optional<ColorCamera> ResolveColorCamera(const std::string& folder,
                                              const std::string& option) {
  if (option == "none") return std::nullopt;
  if (option != "auto") return ReadColorCamera(option);
  const fs::path file = fs::path(folder) / kColorCameraFile;
  if (!fs::exists(file)) return std::nullopt;
  return ReadColorCamera(file.string());
}

/// The values that the format finds, each replaced by the option if given. The
/// lens stays that of the files.
Calibration ResolveCalibration(const std::string& folder,
                               const SequenceFormat& format,
                               const ReaderOptions& options) {
  const std::optional<Calibration> file = format.FindCalibration(folder);
  if (!file && !(options.camera && options.depth_scale > 0)) {
    throw InputError(folder +
                     ": neither calibration.txt nor camera.txt found: expected "
                     "one of them, or intrinsics and depth scale as options");
  }
  Calibration calibration = file.value_or(Calibration());
  if (options.camera) calibration.camera = *options.camera;
  calibration.camera.noise = options.depth.noise;
  if (options.depth_scale > 0) calibration.depth_scale = options.depth_scale;
  const std::optional<ColorCamera> beside =
      ResolveColorCamera(folder, options.color_camera);
  if (beside || options.color_camera == "none") calibration.color = beside;
  return calibration;
}

/// Of the lens of a camera, if it has distortion.
std::shared_ptr<const Undistortion> MakeUndistortion(
    const PinholeCamera& camera, const LensDistortion& lens) {
  if (lens.IsNone()) return nullptr;
  return std::make_shared<const Undistortion>(camera, lens);
}

/// The colour camera for itself.
PinholeCamera PinholeOf(const ColorCamera& color, const cv::Size& size) {
  return {size.width, size.height, color.fx, color.fy, color.cx, color.cy};
}

void CheckSize(const std::string& path, const cv::Size& size,
               const cv::Size& expected) {
  if (size == expected) return;
  throw InputError(path + ": image of " + ToString(size) + ": expected " +
                   ToString(expected) + ", the size of the calibration");
}

/// The same of a header, if the format has one that is known.
void CheckSize(const std::string& path,
               const std::optional<ImageHeader>& header,
               const cv::Size& expected) {
  if (header) CheckSize(path, header->size, expected);
}

std::vector<AssociatedFiles> SelectFrames(std::vector<AssociatedFiles> pairs,
                                          const ReaderOptions& options) {
  const int count = static_cast<int>(pairs.size());
  CheckOption(
      options.first_frame < count, "first_frame", options.first_frame,
      "less than the " + std::to_string(count) + " frames of the sequence");
  pairs.erase(pairs.begin(), pairs.begin() + options.first_frame);
  std::vector<AssociatedFiles> kept;
  for (std::size_t i = 0; i < pairs.size(); i += options.frame_step) {
    kept.push_back(std::move(pairs[i]));
  }
  pairs = std::move(kept);
  if (options.max_frames > 0 &&
      options.max_frames < static_cast<int>(pairs.size())) {
    pairs.resize(options.max_frames);
  }
  return pairs;
}

}  // namespace

void ReaderOptions::Check() const {
  CheckOption(first_frame >= 0, "first_frame", first_frame, "an index >= 0");
  CheckOption(frame_step >= 1, "frame_step", frame_step, "a number >= 1");
  CheckOption(max_frames >= 0, "max_frames", max_frames,
              "a number > 0, or 0 for all");
  CheckOption(std::isfinite(depth_scale) && depth_scale >= 0, "depth_scale",
              depth_scale, "units per metre > 0, or 0 for the file's");
  if (rolling_shutter) {
    CheckOption(*rolling_shutter >= 0 && *rolling_shutter <= 1,
                "rolling_shutter", *rolling_shutter, "seconds from 0 to 1");
  }
  if (camera) camera->Check();
  depth.Check();
}

ImageFolderReader::ImageFolderReader(const std::string& folder,
                                     ReaderOptions options,
                                     const FormatRegistry& formats)
    : folder_(folder), options_(std::move(options)) {
  options_.Check();
  options_.format = ResolveFormat(options_.format, folder_, formats);
  format_ = formats.Make(options_.format);
  pairs_ = SelectFrames(format_->FindFrames(folder_), options_);
  indices_.resize(pairs_.size());
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    indices_[i] =
        options_.first_frame + static_cast<int>(i) * options_.frame_step;
  }
  calibration_ = ResolveCalibration(folder_, *format_, options_);
  CompleteCalibration();
  if (options_.skip_bad_frames) SkipBadFrames();
  if (!options_.trajectory.empty()) FindPoses();
}

void ImageFolderReader::CompleteCalibration() {
  PinholeCamera& camera = calibration_.camera;
  if (camera.width == 0 && camera.height == 0) {
    const auto header = format_->ReadDepthHeader(DepthPath(0));
    const cv::Size size =
        header ? header->size : format_->ReadDepth(DepthPath(0)).size();
    camera.width = size.width;
    camera.height = size.height;
  }
  if (calibration_.depth_scale == 0) {
    throw InputError(folder_ +
                     ": no depth scale beside the intrinsics: expected "
                     "depth_scale as an option, units in a metre");
  }
  try {
    calibration_.Check();
  } catch (const InputError& error) {
    throw InputError(folder_ + ": " + error.what());
  }
  depth_undistortion_ = MakeUndistortion(camera, calibration_.lens);
  color_undistortion_ = depth_undistortion_;
  if (!calibration_.color) return;
  color_undistortion_ = MakeUndistortion(
      PinholeOf(*calibration_.color, color_size()), calibration_.color_lens);
}

void ImageFolderReader::SkipBadFrames() {
  for (const BadFrame& bad : FindBadFrames()) {
    const auto at = std::find(indices_.begin(), indices_.end(), bad.index);
    Skip(static_cast<int>(at - indices_.begin()), bad.reason);
  }
  if (!pairs_.empty()) return;
  throw InputError(skipped_.front().reason + " (and none of the other " +
                   std::to_string(skipped_.size() - 1) +
                   " frames can be read)");
}

std::string ImageFolderReader::TimesNote() const {
  const auto place = std::adjacent_find(
      pairs_.begin(), pairs_.end(),
      [](const AssociatedFiles& one, const AssociatedFiles& next) {
        return !(one.depth.timestamp < next.depth.timestamp);
      });
  if (place == pairs_.end()) return "";
  return folder_ + ": frame " +
         std::to_string(indices_[place - pairs_.begin() + 1]) +
         " has time stamp " + std::to_string(place[1].depth.timestamp) +
         " after " + std::to_string(place[0].depth.timestamp) +
         ": expected ascending seconds";
}

void ImageFolderReader::FindPoses() {
  const Trajectory given = ReadTumTrajectory(options_.trajectory);
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double time = pairs_[i].depth.timestamp;
    const std::optional<Rigid3d> pose = PoseAt(given, time);
    if (!pose) {
      throw InputError(options_.trajectory + ": no pose within 0.02 s of " +
                       std::to_string(time) + " s, frame " +
                       std::to_string(indices_[i]) +
                       ": expected one of every frame");
    }
    poses_[indices_[i]] = *pose;
    const double way =
        (pose->translation() - poses_.at(indices_[0]).translation()).norm();
    if (!(way <= kMaxWay)) {
      throw InputError(options_.trajectory + ": the pose at " +
                       std::to_string(time) + " s is " + std::to_string(way) +
                       " m from that of the first frame: expected " +
                       std::to_string(static_cast<int>(kMaxWay)) +
                       " m at most");
    }
  }
}

int ImageFolderReader::size() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(pairs_.size());
}

std::vector<BadFrame> ImageFolderReader::skipped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return skipped_;
}

cv::Size ImageFolderReader::ExpectedSize() const {
  return {camera().width, camera().height};
}

cv::Size ImageFolderReader::color_size() const {
  if (!calibration_.color) return ExpectedSize();
  return calibration_.color->SizeBeside(ExpectedSize());
}

std::string ImageFolderReader::ColorPath(int i) const {
  return (fs::path(folder_) / pairs_[i].color.file).string();
}

std::string ImageFolderReader::DepthPath(int i) const {
  return (fs::path(folder_) / pairs_[i].depth.file).string();
}

void ImageFolderReader::CheckFiles(int i) const {
  const std::string color = ColorPath(i), depth = DepthPath(i);
  CheckSize(color, format_->ReadColorHeader(color), color_size());
  CheckSize(depth, format_->ReadDepthHeader(depth), ExpectedSize());
}

std::vector<BadFrame> ImageFolderReader::FindBadFrames() const {
  std::vector<std::string> reasons(pairs_.size());
  tbb::parallel_for(0, static_cast<int>(pairs_.size()), [&](int i) {
    try {
      CheckFiles(i);
    } catch (const InputError& error) {
      reasons[i] = error.what();
    }
  });
  std::vector<BadFrame> bad;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (reasons[i].empty()) continue;
    bad.push_back({indices_[i], Stem(static_cast<int>(i)), reasons[i]});
  }
  return bad;
}

void ImageFolderReader::CheckFrames() const {
  const std::vector<BadFrame> bad = FindBadFrames();
  if (bad.empty()) return;
  throw InputError(
      bad.front().reason +
      (bad.size() == 1
           ? std::string()
           : " (and " + std::to_string(bad.size() - 1) + " more bad frames)"));
}

void ImageFolderReader::Skip(int i, const std::string& reason) {
  BadFrame bad{indices_[i], Stem(i), reason};
  const std::lock_guard<std::mutex> lock(mutex_);
  pairs_.erase(pairs_.begin() + i);
  indices_.erase(indices_.begin() + i);
  const auto after = std::find_if(
      skipped_.begin(), skipped_.end(),
      [&](const BadFrame& item) { return item.index > bad.index; });
  skipped_.insert(after, std::move(bad));
}

std::string ImageFolderReader::Stem(int i) const {
  return fs::path(pairs_.at(i).depth.file).stem().string();
}

std::string ImageFolderReader::ColorStem(int i) const {
  return fs::path(pairs_.at(i).color.file).stem().string();
}

cv::Mat ImageFolderReader::ReadColor(int i) const {
  const std::string path = ColorPath(i);
  const cv::Mat color = format_->ReadColor(path);
  CheckSize(path, color.size(), color_size());
  return color_undistortion_ ? color_undistortion_->Color(color) : color;
}

cv::Mat_<float> ImageFolderReader::ReadDepth(int i) const {
  const std::string path = DepthPath(i);
  const cv::Mat raw = format_->ReadDepth(path);
  CheckSize(path, raw.size(), ExpectedSize());
  const cv::Mat_<float> depth = DepthInMetres(raw, calibration_.depth_scale);
  return depth_undistortion_ ? depth_undistortion_->Depth(depth) : depth;
}

Trajectory ImageFolderReader::FindSequencePoses() const {
  return format_->FindPoses(folder_, pairs_);
}

Frame ImageFolderReader::Read(int i) const {
  CheckFiles(i);
  Frame frame;
  frame.index = indices_[i];
  frame.timestamp = pairs_[i].depth.timestamp;
  const auto pose = poses_.find(frame.index);
  if (pose != poses_.end()) frame.world_from_camera = pose->second;
  frame.stem = Stem(i);
  frame.color_stem = ColorStem(i);
  frame.color = ReadColor(i);
  frame.depth = FilterDepth(ReadDepth(i), options_.depth);
  return frame;
}

/// Empty if the frame is left out.
std::optional<Frame> ImageFolderReader::ReadOrSkip() {
  try {
    return Read(next_);
  } catch (const InputError& error) {
    if (!options_.skip_bad_frames) throw;
    Skip(next_, error.what());
    return std::nullopt;
  }
}

void ImageFolderReader::SkipTo(int i) {
  if (options_.skip_bad_frames) {
    while (next_ < i && Next()) {
    }
  }
  next_ = i;
}

std::optional<Frame> ImageFolderReader::Next() {
  std::optional<Frame> frame;
  while (!frame && next_ < size()) frame = ReadOrSkip();
  if (frame) ++next_;
  return frame;
}

}  // namespace splitfusion
