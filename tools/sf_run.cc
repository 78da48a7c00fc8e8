// Runs SplitFusion on one RGB-D sequence and writes a run directory.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "interruption.h"
#include "mask_flags.h"
#include "progress_line.h"
#include "run_flags.h"
#include "sequence_flags.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/read_ahead.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/blas_threads.h"
#include "splitfusion/lib/report/frame_pictures.h"
#include "splitfusion/lib/report/library_versions.h"
#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/sequence/tum_reader.h"
#include "splitfusion/pipelines/split_fusion.h"
#include "splitfusion/pipelines/surface_output.h"
#include "tool_main.h"

DEFINE_string(output, "", "Run directory to write.");
DEFINE_bool(overwrite, false, "Replace an earlier run in --output.");
DEFINE_int32(warped_every, 10, "Warped meshes of every n-th frame; 0 = none.");
DEFINE_int32(pictures_every, 10, "Pictures of every n-th frame; 0 = none.");
DEFINE_bool(warped_whole, false,
            "Warped meshes hold what was seen only later, too.");
DEFINE_bool(write_masks, true, "Write refined masks of every frame.");
DECLARE_string(masks);
DECLARE_double(max_depth);
DECLARE_double(min_depth);
DECLARE_string(preset);
DECLARE_string(sequence);

namespace splitfusion {
namespace {

/// Refuses to clear a folder that the run is to read from.
void CheckNotInOutput(const std::string& flag, const std::string& input) {
  namespace fs = std::filesystem;
  if (!FLAGS_overwrite || input.empty() || !fs::exists(input)) return;
  const fs::path output = fs::weakly_canonical(FLAGS_output);
  const fs::path path = fs::weakly_canonical(input);
  const auto end =
      std::mismatch(output.begin(), output.end(), path.begin(), path.end());
  CheckOption(end.first != output.end(), flag, input,
              "a folder outside of --output, which is overwritten");
}

/// One run: frames in, run directory out.
class Run {
 public:
  Run(const TumReaderOptions& reading, const PipelineOptions& options)
      : reader_(FLAGS_sequence, reading),
        fusion_(reader_.camera(), options, LabelsFromFlags(),
                SegmenterFromFlags(reader_, options, FLAGS_output)),
        directory_(FLAGS_output, FLAGS_overwrite,
                   {FLAGS_preset, FlagfileText(), LibraryVersions()}),
        frames_([this] { return ReadNext(); }, ThreadsFromFlags() > 1) {
    WriteCalibration();
  }

  void Execute() {
    try {
      while (!Interrupted() && ProcessNext()) {
      }
    } catch (const std::exception&) {
      // A broken frame ends the run; what was computed until then is kept.
      EndProgress();
      WriteResults(/*complete=*/false);
      throw;
    }
    WriteResults(done_ == reader_.size());
    if (done_ == reader_.size()) return CheckReconstructed();
    throw std::runtime_error("interrupted after " + std::to_string(done_) +
                             " of " + std::to_string(reader_.size()) +
                             " frames; what was computed is in " +
                             FLAGS_output);
  }

 private:
  /// The intrinsics in use, so that the run can be evaluated by itself.
  void WriteCalibration() const {
    const Calibration& used = reader_.calibration();
    WriteFileAtomically(directory_.paths().Calibration(),
                        [&](std::ostream& out) {
                          out << std::setprecision(17)
                              << "# fx fy cx cy width height depth_factor\n"
                              << used.camera.fx << ' ' << used.camera.fy << ' '
                              << used.camera.cx << ' ' << used.camera.cy << ' '
                              << used.camera.width << ' ' << used.camera.height
                              << ' ' << used.depth_scale << '\n';
                        });
  }

  /// What a run begins with.
  static std::string ExpectedDepth() {
    std::ostringstream text;
    text << "expected depth from " << FLAGS_min_depth << " to "
         << FLAGS_max_depth << " m (--min_depth, --max_depth, --depth_scale)";
    return text.str();
  }

  /// @throw InputError if there was nothing to reconstruct.
  void CheckReconstructed() const {
    if (!fusion_.surfaces().empty()) return;
    throw InputError(FLAGS_sequence + ": nothing to reconstruct in any of " +
                     std::to_string(done_) + " frames: " + ExpectedDepth());
  }

  /// Once a run.
  void WarnOfMissingDepth(const Frame& frame) {
    if (warned_of_depth_ || !fusion_.surfaces().empty()) return;
    warned_of_depth_ = true;
    LOG(WARNING) << "frame " << frame.index << ", " << frame.stem
                 << ": no background to begin with: " << ExpectedDepth()
                 << "; passed over until there is";
  }

  bool ProcessNext() {
    const Stopwatch frame_time;
    std::optional<PreparedFrame> prepared = frames_.Next();
    if (!prepared) return false;
    const Frame frame = prepared->frame;
    FrameReport report = fusion_.ProcessFrame(std::move(*prepared));
    // Less than the sum of its parts: reading overlaps with the frame before.
    report.total_seconds = frame_time.Seconds();
    directory_.AddFrame(report, fusion_.trajectory().back());
    WarnOfMissingDepth(frame);
    WarnOfLostSurfaces(report);
    WarnOfCoarseGraphs(report.frame);
    const Stopwatch writing;
    WritePictures(frame, report.frame);
    directory_.AddWritingSeconds(writing.Seconds());
    ++done_;
    ShowProgress(
        done_, reader_.size(),
        "frames, " + std::to_string(fusion_.surfaces().size()) + " surfaces",
        since_start_.Seconds() / done_ * (reader_.size() - done_));
    return true;
  }

  std::optional<PreparedFrame> ReadNext() {
    const Stopwatch reading;
    std::optional<Frame> frame = reader_.Next();
    if (!frame) return std::nullopt;
    const double seconds = reading.Seconds();
    PreparedFrame prepared = fusion_.Prepare(*frame);
    prepared.read_seconds += seconds;
    return prepared;
  }

  static void WarnOfLostSurfaces(const FrameReport& report) {
    for (const SurfaceReport& surface : report.surfaces) {
      if (surface.state != "lost") continue;
      LOG(WARNING) << "frame " << report.frame << ": surface " << surface.id
                   << " (" << surface.label << ") lost: " << surface.reason;
    }
  }

  /// Once a surface.
  void WarnOfCoarseGraphs(int frame) {
    for (const auto& [id, surface] : fusion_.surfaces()) {
      const double planned = surface->planned_node_spacing();
      const double spacing = surface->graph().node_spacing;
      if (spacing <= planned || !coarse_.insert(id).second) continue;
      LOG(WARNING) << "frame " << frame << ": surface " << id << " ("
                   << surface->label() << ") has nodes every " << 1000 * spacing
                   << " mm instead of " << 1000 * planned
                   << " mm, to keep --max_nodes="
                   << surface->options().graph.max_nodes;
    }
  }

  void WritePictures(const Frame& frame, int index) const {
    if (FLAGS_write_masks) {
      WriteMask(directory_.paths(), frame.stem, fusion_.labels());
    }
    if (FLAGS_pictures_every == 0 || index % FLAGS_pictures_every != 0) return;
    const SceneRendering scene = RenderScene(
        fusion_.surfaces(), fusion_.camera(), fusion_.options().ray_cast);
    cv::Mat depth;
    cv::extractChannel(scene.map.points, depth, 2);
    WriteFramePictures(directory_.paths(), index,
                       {frame.color, frame.depth, fusion_.labels(),
                        scene.map.color, depth, scene.map.normals});
  }

  void WriteResults(bool complete) {
    const Stopwatch writing;
    fusion_.Finish();
    for (const auto& [id, surface] : fusion_.surfaces()) {
      WriteSurface(directory_.paths(), *surface,
                   {FLAGS_warped_every, FLAGS_warped_whole});
      directory_.SetSurfaceSize(
          id, surface->graph().size(),
          static_cast<int>(surface->mesh().vertices.size()));
    }
    directory_.AddWritingSeconds(writing.Seconds());
    directory_.Finish(complete);
  }

  TumReader reader_;
  SplitFusion fusion_;
  RunDirectory directory_;
  Stopwatch since_start_;
  std::set<int> coarse_;  // Surfaces whose graph is coarser than planned.
  bool warned_of_depth_ = false;
  int done_ = 0;
  ReadAhead<PreparedFrame> frames_;  // Last: its thread uses the others.
};

int RunSequence() {
  const TumReaderOptions reading = ReaderOptionsFromFlags();
  const PipelineOptions options = PipelineOptionsFromFlags();
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  CheckOption(FLAGS_warped_every >= 0, "warped_every", FLAGS_warped_every,
              "a number of frames, or 0");
  CheckOption(FLAGS_pictures_every >= 0, "pictures_every", FLAGS_pictures_every,
              "a number of frames, or 0");
  CheckNotInOutput("sequence", FLAGS_sequence);
  CheckNotInOutput("masks", FLAGS_masks);
  CatchInterruption();
  const ThreadLimit threads;
  SetBlasThreads(1);
  Run(reading, options).Execute();
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(
      argc, argv,
      "Tracks and maps the rigid and non-rigid surfaces of an RGB-D sequence.\n"
      "sf_run --sequence=DIR --output=RUN [--masks=DIR|none] [--preset=NAME]\n"
      "       [--model=FILE.onnx --decoder=yolov8seg|yolact]\n",
      splitfusion::RunSequence);
}
