// Writes a sequence of any layout in that of the TUM benchmark.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "camera_flags.h"
#include "progress_line.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pending_folder.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/base/thread_limit.h"
#include "splitfusion/lib/calibration/color_camera_estimate.h"
#include "splitfusion/lib/frame/color_registration.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/lib/sequence/tum_writer.h"
#include "tool_main.h"

DEFINE_string(output, "", "Folder to write.");
DEFINE_bool(overwrite, false, "Replace an earlier one of sf_convert.");
DECLARE_string(sequence);
DECLARE_int32(threads);

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Writes an RGB-D sequence of any layout that is known in that of the TUM\n"
    "benchmark: without lens distortion, colour registered to the depth, with\n"
    "the camera poses that come with it.\n"
    "  sf_convert --sequence=DIR|FILE --output=DIR [--format=NAME]\n";

/// The colour camera to register by: what is known, or what the images say.
std::optional<ColorCamera> ColorCameraOf(const ImageFolderReader& reader) {
  const std::optional<ColorCamera>& known = reader.calibration().color;
  if (known || reader.options().color_camera != "auto") return known;
  const ColorCameraEstimate estimate = EstimateColorCamera(reader);
  if (!estimate.IsNeeded()) return std::nullopt;
  LOG(WARNING) << estimate.Text() << "; registered (--color_camera)";
  return estimate.camera;
}

/// One pass over the sequence.
class Conversion {
 public:
  Conversion(const ImageFolderReader& reader, const std::string& folder)
      : reader_(reader),
        color_camera_(ColorCameraOf(reader)),
        given_(reader.FindSequencePoses()),
        writer_(folder) {}

  void Execute() {
    const Stopwatch stopwatch;
    for (int i = 0; i < reader_.size(); ++i) {
      AddOrSkip(i);
      progress_.Show(i + 1, reader_.size(), "frames",
                     stopwatch.Seconds() / (i + 1) * (reader_.size() - i - 1));
    }
    progress_.End();
    writer_.Finish(reader_.camera(), poses_);
  }

  int frames() const { return frames_; }
  int poses() const { return static_cast<int>(poses_.size()); }

 private:
  void AddOrSkip(int i) {
    try {
      Add(i);
    } catch (const InputError& error) {
      if (!reader_.options().skip_bad_frames) throw;
      progress_.End();
      LOG(WARNING) << error.what() << "; left out";
    }
  }

  void Add(int i) {
    cv::Mat color = reader_.ReadColor(i);
    const cv::Mat_<float> depth = reader_.ReadDepth(i);
    if (color_camera_) {
      color = RegisterColor(
          color, ColorPlaces(reader_.camera(), *color_camera_, depth));
    }
    const double time = reader_.pairs()[i].depth.timestamp;
    writer_.Add(reader_.Stem(i), time, color, depth);
    ++frames_;
    const std::optional<Rigid3d> pose = PoseAt(given_, time);
    if (pose) poses_.push_back({time, *pose});
  }

  const ImageFolderReader& reader_;
  std::optional<ColorCamera> color_camera_;
  Trajectory given_;
  TumWriter writer_;
  Trajectory poses_;
  ProgressLine progress_;
  int frames_ = 0;
};

int Run() {
  const ReaderOptions options = ImagesFromFlags();
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  const ThreadLimit threads(FLAGS_threads);
  const ImageFolderReader reader(FLAGS_sequence, options);
  if (!options.skip_bad_frames) reader.CheckFrames();
  PendingFolder folder(FLAGS_output, "sf_convert", FLAGS_overwrite);
  Conversion conversion(reader, folder.path().string());
  conversion.Execute();
  const std::vector<std::string> kept = folder.Commit();
  if (!kept.empty()) {
    LOG(WARNING) << FLAGS_output << ": " << kept.size()
                 << " files that sf_convert did not write stay there, such as "
                 << kept.front();
  }
  std::printf("%s: %d frames of %dx%d, %d with a pose\n", FLAGS_output.c_str(),
              conversion.frames(), reader.camera().width,
              reader.camera().height, conversion.poses());
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(argc, argv, splitfusion::kUsage,
                               splitfusion::Run);
}
