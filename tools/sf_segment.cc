// Makes the instance masks of a sequence with a network.

#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "network_flags.h"
#include "progress_line.h"
#include "sequence_flags.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/process_memory.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/base/thread_limit.h"
#include "splitfusion/lib/report/detection_picture.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/segmentation/mask_folder_writer.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "tool_main.h"

DEFINE_string(output, "", "Folder of masks to write or to complete.");
DEFINE_bool(overwrite, false, "Replace the masks in --output.");
DEFINE_string(overlays, "", "Folder for pictures of the masks; empty = none.");
DECLARE_string(sequence);
DECLARE_int32(threads);

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Makes the instance masks of an RGB-D sequence with a network, for\n"
    "sf_run --masks=MASKS. The same command resumes an interrupted one.\n"
    "  sf_segment --sequence=DIR --model=FILE.onnx --decoder=yolov8seg|yolact\n"
    "             --output=MASKS [--overlays=DIR]\n";

/// Colour images of the sequence with the stems of their depth images.
class ColorFrames {
 public:
  ColorFrames(const ReaderOptions& options, const FormatRegistry& formats)
      : format_(formats.Make(
            ResolveFormat(options.format, FLAGS_sequence, formats))),
        pairs_(format_->FindFrames(FLAGS_sequence)) {
    first_ = options.first_frame;
    step_ = options.frame_step;
    const int all = static_cast<int>(pairs_.size());
    CheckOption(first_ < all, "first_frame", first_,
                "less than " + std::to_string(all) + ", the number of frames");
    const int left = (all - first_ + step_ - 1) / step_;
    count_ = options.max_frames > 0 ? std::min(left, options.max_frames) : left;
  }

  /// Number of frames that are read.
  int count() const { return count_; }

  /// Of the i-th of them, in the sequence.
  int IndexOf(int i) const { return first_ + i * step_; }

  std::string Stem(int index) const {
    return fs::path(pairs_[index].depth.file).stem().string();
  }

  Frame Read(int index) const {
    Frame frame;
    frame.index = index;
    frame.timestamp = pairs_[index].depth.timestamp;
    frame.stem = Stem(index);
    const fs::path color = fs::path(FLAGS_sequence) / pairs_[index].color.file;
    frame.color_stem = color.stem().string();
    frame.color = format_->ReadColor(color.string());
    return frame;
  }

 private:
  std::unique_ptr<SequenceFormat> format_;
  std::vector<AssociatedFiles> pairs_;
  int first_ = 0;
  int step_ = 1;
  int count_ = 0;
};

/// One pass over the sequence.
class Segmentation {
 public:
  Segmentation(const ReaderOptions& options, const FormatRegistry& formats)
      : frames_(options, formats),
        network_(NetworkFromFlags()),
        writer_(FLAGS_output, SettingsOf(*network_)) {}

  void Execute() {
    for (int i = 0; i < frames_.count(); ++i) {
      const int index = frames_.IndexOf(i);
      if (!IsDone(frames_.Stem(index))) Process(frames_.Read(index));
      ShowProgress(i + 1);
    }
    progress_.End();
    std::printf(
        "%d frames, %d of them now, %d instances, %.3f s a frame, peak memory "
        "%.0f MB\n",
        frames_.count(), segmented_, instances_,
        segmented_ > 0 ? seconds_ / segmented_ : 0.0, PeakMemoryBytes() / 1e6);
  }

 private:
  /// A folder holds the masks of one sequence by one network.
  static std::map<std::string, std::string> SettingsOf(
      const NetworkSegmenter& network) {
    std::map<std::string, std::string> settings = network.Settings();
    settings["sequence"] = fs::weakly_canonical(FLAGS_sequence).string();
    return settings;
  }

  static std::string OverlayPath(const std::string& stem) {
    return (fs::path(FLAGS_overlays) / (stem + ".png")).string();
  }

  bool IsDone(const std::string& stem) const {
    return writer_.Has(stem) &&
           (FLAGS_overlays.empty() || fs::exists(OverlayPath(stem)));
  }

  void Process(const Frame& frame) {
    const std::vector<InstanceMask> instances =
        writer_.Has(frame.stem) ? ReadBack(frame) : Segment(frame);
    if (FLAGS_overlays.empty()) return;
    WriteImage(OverlayPath(frame.stem),
               DetectionPicture(frame.color, instances));
  }

  std::vector<InstanceMask> Segment(const Frame& frame) {
    const Stopwatch stopwatch;
    std::vector<InstanceMask> instances = network_->Segment(frame);
    seconds_ += stopwatch.Seconds();
    ++segmented_;
    instances_ += static_cast<int>(instances.size());
    writer_.Write(frame, instances);
    return instances;
  }

  /// Masks of an earlier start, for their picture.
  std::vector<InstanceMask> ReadBack(const Frame& frame) {
    if (!earlier_) earlier_.emplace(FLAGS_output);
    return earlier_->Segment(frame);
  }

  void ShowProgress(int done) {
    const double a_frame =
        segmented_ > 0 ? since_start_.Seconds() / segmented_ : 0.0;
    progress_.Show(done, frames_.count(),
                   "frames, " + std::to_string(instances_) + " instances",
                   a_frame * (frames_.count() - done));
  }

  ColorFrames frames_;
  std::unique_ptr<NetworkSegmenter> network_;
  MaskFolderWriter writer_;
  std::optional<MaskFolderSegmenter> earlier_;
  ProgressLine progress_;
  Stopwatch since_start_;
  double seconds_ = 0;  // In the network, its input and its outputs.
  int segmented_ = 0;
  int instances_ = 0;
};

int Run(const FormatRegistry& formats) {
  const ReaderOptions options = FramesFromFlags();
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  CheckOption(fs::weakly_canonical(FLAGS_output) !=
                  fs::weakly_canonical(FLAGS_sequence),
              "output", FLAGS_output,
              "another folder than the sequence itself");
  const ThreadLimit threads(FLAGS_threads);
  if (FLAGS_overwrite) ClearMaskFolder(FLAGS_output);
  Segmentation(options, formats).Execute();
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(argc, argv, splitfusion::kUsage, [] {
    return splitfusion::Run(splitfusion::BuiltinFormats());
  });
}
