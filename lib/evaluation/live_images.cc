#include "splitfusion/lib/evaluation/live_images.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

void CheckSource(const RecordedRun& run) {
  if (run.sequence.empty()) {
    throw InputError(run.root + "/options.flags: no --sequence");
  }
  if (!fs::is_directory(run.sequence)) {
    throw InputError(run.sequence +
                     ": expected the folder of the sequence that "
                     "options.flags names");
  }
  if (!run.camera) throw InputError(run.root + ": no camera intrinsics");
}

void CheckSize(const std::string& path, const cv::Size& size,
               const PinholeCamera& camera) {
  const cv::Size expected(camera.width, camera.height);
  if (size == expected) return;
  throw InputError(path + ": " + ToString(size) + " pixels: expected " +
                   ToString(expected));
}

}  // namespace

LiveImages::LiveImages(const RecordedRun& run)
    : run_(run.root),
      sequence_(run.sequence),
      filter_(run.reading.depth_filter) {
  CheckSource(run);
  const ImageFolderReader reader(run.sequence, run.reading, run.formats);
  format_ = run.formats.Make(reader.options().format);
  calibration_ = reader.calibration();
  files_ = reader.pairs();
}

cv::Mat_<float> LiveImages::Depth(const RecordedFrame& frame) const {
  CheckOption(
      frame.index >= 0 && static_cast<std::size_t>(frame.index) < files_.size(),
      sequence_ + ": frame", frame.index,
      "one of its " + std::to_string(files_.size()));
  const fs::path path = fs::path(sequence_) / files_[frame.index].depth.file;
  const std::string stem = path.stem().string();
  if (stem != frame.stem) {
    throw InputError(sequence_ + ": frame " + std::to_string(frame.index) +
                     " is '" + stem + "': expected '" + frame.stem +
                     "' as in frames.jsonl");
  }
  const cv::Mat raw = format_->ReadDepth(path.string());
  CheckSize(path.string(), raw.size(), camera());
  return DepthInMetres(raw, calibration_.depth_scale);
}

cv::Mat_<float> LiveImages::FilteredDepth(const RecordedFrame& frame) const {
  return FilterDepth(Depth(frame), filter_);
}

cv::Mat_<std::uint16_t> LiveImages::ReadIds(const std::string& path) const {
  const cv::Mat_<std::uint16_t> ids = ReadLabelImage(path);
  CheckSize(path, ids.size(), camera());
  return ids;
}

cv::Mat_<std::uint16_t> LiveImages::Mask(const RecordedFrame& frame) const {
  return ReadIds((fs::path(run_) / "masks" / (frame.stem + ".png")).string());
}

cv::Mat_<std::uint16_t> LiveImages::Labels(const std::string& folder,
                                           const RecordedFrame& frame) const {
  const fs::path path = fs::path(folder) / (frame.stem + ".png");
  if (folder.empty() || frame.stem.empty() || !fs::exists(path)) return {};
  return ReadIds(path.string());
}

}  // namespace splitfusion
