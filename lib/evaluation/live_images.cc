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
  if (!fs::exists(run.sequence)) {
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

cv::Mat_<std::uint16_t> ReadIds(const std::string& folder,
                                const RecordedFrame& frame,
                                const PinholeCamera& camera) {
  const fs::path path = fs::path(folder) / (frame.stem + ".png");
  if (folder.empty() || frame.stem.empty() || !fs::exists(path)) return {};
  const cv::Mat_<std::uint16_t> ids = ReadLabelImage(path.string());
  CheckSize(path.string(), ids.size(), camera);
  return ids;
}

std::map<int, int> CountPixels(const cv::Mat_<std::uint16_t>& ids,
                               const cv::Mat_<float>* live) {
  std::map<int, int> counts;
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      if (live == nullptr || (*live)(v, u) > 0) ++counts[ids(v, u)];
    }
  }
  return counts;
}

LiveImages::LiveImages(const RecordedRun& run)
    : run_(run.root), sequence_(run.sequence), filter_(run.reading.depth) {
  CheckSource(run);
  reader_ = std::make_shared<const ImageFolderReader>(run.sequence, run.reading,
                                                      run.formats);
}

const PinholeCamera& LiveImages::camera() const { return reader_->camera(); }

cv::Mat_<float> LiveImages::Depth(const RecordedFrame& frame) const {
  CheckOption(frame.index >= 0 && frame.index < reader_->size(),
              sequence_ + ": frame", frame.index,
              "one of its " + std::to_string(reader_->size()));
  const std::string stem = reader_->Stem(frame.index);
  if (stem != frame.stem) {
    throw InputError(sequence_ + ": frame " + std::to_string(frame.index) +
                     " is '" + stem + "': expected '" + frame.stem +
                     "' as in frames.jsonl");
  }
  return reader_->ReadDepth(frame.index);
}

cv::Mat_<float> LiveImages::FilteredDepth(const RecordedFrame& frame) const {
  return FilterDepth(Depth(frame), filter_);
}

cv::Mat_<std::uint16_t> LiveImages::Mask(const RecordedFrame& frame) const {
  const std::string folder = (fs::path(run_) / "masks").string();
  const cv::Mat_<std::uint16_t> mask = ReadIds(folder, frame, camera());
  if (!mask.empty()) return mask;
  throw InputError(folder + "/" + frame.stem + ".png: cannot be opened");
}

}  // namespace splitfusion
