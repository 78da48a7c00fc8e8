// Runs SplitFusion on one RGB-D sequence and writes a run directory.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "identity_flags.h"
#include "interruption.h"
#include "mask_flags.h"
#include "progress_line.h"
#include "run_flags.h"
#include "sequence_flags.h"
#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/archive_file.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/read_ahead.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/blas_threads.h"
#include "splitfusion/lib/report/disk_space.h"
#include "splitfusion/lib/report/frame_pictures.h"
#include "splitfusion/lib/report/library_versions.h"
#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/report/run_folder.h"
#include "splitfusion/lib/sequence/tum_reader.h"
#include "splitfusion/pipelines/checkpoint_schedule.h"
#include "splitfusion/pipelines/split_fusion.h"
#include "splitfusion/pipelines/surface_output.h"
#include "tool_main.h"

DEFINE_string(output, "", "Run directory to write.");
DEFINE_bool(overwrite, false, "Replace an earlier run in --output.");
DEFINE_bool(keep_same, false,
            "With --overwrite: but not a finished run of the same identity.");
DEFINE_bool(resume, true, "Go on with an unfinished run of the same options.");
DEFINE_int32(checkpoint_every, 0,
             "Save the state every n-th frame; 0 = by time, -1 = never.");
DEFINE_bool(
    keep_checkpoints, false,
    "Keep all states in RUN/checkpoints, for --from.");
DEFINE_string(from, "",
              "Start from the state of this run with --keep_checkpoints.");
DEFINE_int32(at, 0, "First frame after that state.");
DEFINE_bool(print_identity, false,
            "Print what decides the result, run nothing.");
DEFINE_int32(warped_every, 10, "Warped meshes of every n-th frame; 0 = none.");
DEFINE_int32(pictures_every, 10, "Pictures of every n-th frame; 0 = none.");
DEFINE_bool(warped_whole, false,
            "Warped meshes hold what was seen only later, too.");
DEFINE_bool(write_masks, true, "Write refined masks of every frame.");
DECLARE_int32(first_frame);
DECLARE_double(max_depth);
DECLARE_double(min_depth);
DECLARE_string(masks);
DECLARE_string(preset);
DECLARE_string(sequence);

namespace splitfusion {
namespace {

/// Of checkpoint.bin: another one with every change of what it holds.
constexpr std::uint32_t kCheckpointVersion = SplitFusion::kStateVersion;

/// Refuses to replace what the run is to read from.
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

/// The run directory as the flags ask for it.
RunFolder OpenRunFolder(const RunIdentity& identity) {
  RunFolderOptions options;
  options.overwrite = FLAGS_overwrite;
  options.keep_same = FLAGS_keep_same;
  options.resume = FLAGS_resume;
  return RunFolder(FLAGS_output, identity, options);
}

/// Frames in and surfaces out: what a run computes.
struct Reconstruction {
  /// All images are looked at first.
  Reconstruction(const TumReaderOptions& reading,
                 const PipelineOptions& options)
      : reader(FLAGS_sequence, reading),
        fusion(Checked(reader, reading).camera(), options, LabelsFromFlags(),
               SegmenterFromFlags(reader, options,
                                  RunPaths(FLAGS_output).Unfinished())) {}

  TumReader reader;
  SplitFusion fusion;

 private:
  static const TumReader& Checked(const TumReader& reader,
                                  const TumReaderOptions& reading) {
    if (!reading.skip_bad_frames) reader.CheckFrames();
    return reader;
  }
};

/// One run: frames in, run directory out.
class Run {
 public:
  /// `make`: what begins with the first frame.
  Run(std::unique_ptr<Reconstruction> work,
      const std::function<std::unique_ptr<Reconstruction>()>& make,
      RunFolder* folder)
      : work_(std::move(work)),
        folder_(*folder),
        schedule_(FLAGS_checkpoint_every) {
    if (folder_.start() == RunStart::kResumed && !Resume()) work_ = make();
    if (!directory_) {
      OpenDirectory();
      if (!FLAGS_from.empty()) StartFromOther();
    }
    if (!folder_.note().empty())
      LOG(WARNING) << FLAGS_output << ": " << folder_.note();
    WriteCalibration();
    frames_.emplace([this] { return ReadNext(); }, ThreadsFromFlags() > 1);
  }

  void Execute() {
    try {
      while (!Interrupted() && ProcessNext()) {
      }
      if (done_ == work_->reader.size()) CheckReconstructed();
    } catch (const std::exception& error) {
      // What was computed until then is kept.
      EndProgress();
      WriteAfterFailure(error.what());
      throw;
    }
    if (done_ == work_->reader.size())
      return WriteResults(RunStatus::kComplete);
    SaveCheckpoint();
    WriteResults(RunStatus::kIncomplete);
    throw std::runtime_error("interrupted after " + std::to_string(done_) +
                             " of " + std::to_string(work_->reader.size()) +
                             " frames; what was computed is in " + where_ +
                             ", and the same command goes on");
  }

 private:
  void OpenDirectory() {
    directory_.emplace(
        folder_.unfinished().root(),
        RunFacts{FLAGS_preset, FlagfileText(), LibraryVersions()},
        folder_.start() == RunStart::kResumed);
  }

  /// Goes on from the checkpoint; false if that is of no use.
  bool Resume() {
    try {
      OpenDirectory();
      ReadArchiveFile(folder_.unfinished().Checkpoint(), kCheckpointVersion,
                      [&](ArchiveReader* archive) { Serialize(archive); });
    } catch (const InputError& error) {
      directory_.reset();
      done_ = 0;
      coarse_.clear();
      warned_of_depth_ = false;
      folder_.StartAfresh(std::string("begins anew: ") + error.what());
      return false;
    }
    work_->reader.SkipTo(done_);
    folder_.RecordResumption(done_);
    LOG(INFO) << FLAGS_output << ": goes on after " << done_ << " of "
              << work_->reader.size() << " frames";
    return true;
  }

  /// Indices of frames without usable images.
  std::vector<int> SkippedFrames() const {
    std::vector<int> frames;
    for (const BadFrame& bad : work_->reader.skipped()) {
      frames.push_back(bad.index);
    }
    return frames;
  }

  void WarnOfSkippedFrames() const {
    const std::vector<BadFrame> skipped = work_->reader.skipped();
    if (skipped.empty()) return;
    LOG(WARNING) << skipped.size() << " frames are left out, the first: "
                 << skipped.front().reason;
  }

  /// All that later frames and results depend on.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(done_, coarse_, warned_of_depth_, work_->fusion, *directory_);
  }

  /// The state alone, without what this run reported.
  template <typename Archive>
  void SerializeState(Archive* archive) {
    ExpectSame(archive, "first_frame", FLAGS_first_frame);
    (*archive)(done_, work_->fusion);
  }

  void StartFromOther() {
    ReadArchiveFile(RunPaths(FLAGS_from).KeptCheckpoint(FLAGS_at),
                    kCheckpointVersion,
                    [&](ArchiveReader* archive) { SerializeState(archive); });
    work_->reader.SkipTo(done_);
  }

  void SaveCheckpoint() {
    const Stopwatch writing;
    if (FLAGS_keep_checkpoints) {
      WriteArchiveFile(
          folder_.unfinished().KeptCheckpoint(FLAGS_first_frame + done_),
          kCheckpointVersion,
          [&](ArchiveWriter* archive) { SerializeState(archive); });
    }
    WriteArchiveFile(folder_.unfinished().Checkpoint(), kCheckpointVersion,
                     [&](ArchiveWriter* archive) { Serialize(archive); });
    schedule_.Saved(writing.Seconds());
    directory_->AddWritingSeconds(writing.Seconds());
    since_checkpoint_.Restart();
  }

  /// The intrinsics in use, so that the run can be evaluated by itself.
  void WriteCalibration() const {
    const Calibration& used = work_->reader.calibration();
    WriteFileAtomically(directory_->paths().Calibration(),
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
    if (!work_->fusion.surfaces().empty()) return;
    throw InputError(FLAGS_sequence + ": nothing to reconstruct in any of " +
                     std::to_string(done_) + " frames: " + ExpectedDepth());
  }

  /// Once a run.
  void WarnOfMissingDepth(const Frame& frame) {
    if (warned_of_depth_ || !work_->fusion.surfaces().empty()) return;
    warned_of_depth_ = true;
    LOG(WARNING) << "frame " << frame.index << ", " << frame.stem
                 << ": no background to begin with: " << ExpectedDepth()
                 << "; passed over until there is";
  }

  bool ProcessNext() {
    const Stopwatch frame_time;
    std::optional<PreparedFrame> prepared = frames_->Next();
    if (!prepared) return false;
    const Frame frame = prepared->frame;
    FrameReport report = work_->fusion.ProcessFrame(std::move(*prepared));
    // Less than the sum of its parts: reading overlaps with the frame before.
    report.total_seconds = frame_time.Seconds();
    folder_.CheckHeld();
    directory_->AddFrame(report, work_->fusion.trajectory().back());
    WarnOfMissingDepth(frame);
    WarnOfLostSurfaces(report);
    WarnOfCoarseGraphs(report.frame);
    const Stopwatch writing;
    WritePictures(frame, report.frame);
    directory_->AddWritingSeconds(writing.Seconds());
    ++done_;
    if (done_ < work_->reader.size() &&
        schedule_.IsDue(since_checkpoint_.Seconds())) {
      SaveCheckpoint();
    }
    ShowProgress(
        done_, work_->reader.size(),
        "frames, " + std::to_string(work_->fusion.surfaces().size()) +
            " surfaces",
        since_start_.Seconds() / done_ * (work_->reader.size() - done_));
    return true;
  }

  std::optional<PreparedFrame> ReadNext() {
    const Stopwatch reading;
    std::optional<Frame> frame = work_->reader.Next();
    if (!frame) return std::nullopt;
    const double seconds = reading.Seconds();
    PreparedFrame prepared = work_->fusion.Prepare(*frame);
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
    for (const auto& [id, surface] : work_->fusion.surfaces()) {
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
      WriteMask(directory_->paths(), frame.stem, work_->fusion.labels());
    }
    if (FLAGS_pictures_every == 0 || index % FLAGS_pictures_every != 0) return;
    const SceneRendering scene =
        RenderScene(work_->fusion.surfaces(), work_->fusion.camera(),
                    work_->fusion.options().ray_cast);
    cv::Mat depth;
    cv::extractChannel(scene.map.points, depth, 2);
    WriteFramePictures(directory_->paths(), index,
                       {frame.color, frame.depth, work_->fusion.labels(),
                        scene.map.color, depth, scene.map.normals});
  }

  void WriteResults(RunStatus status, const std::string& error = "") {
    folder_.CheckHeld();
    const Stopwatch writing;
    work_->fusion.Finish();
    for (const auto& [id, surface] : work_->fusion.surfaces()) {
      WriteSurface(directory_->paths(), *surface,
                   {FLAGS_warped_every, FLAGS_warped_whole});
      directory_->SetSurfaceSize(
          id, surface->graph().size(),
          static_cast<int>(surface->mesh().vertices.size()));
    }
    directory_->AddWritingSeconds(writing.Seconds());
    directory_->Finish(
        {status, error, folder_.marker().resumed_at, SkippedFrames()});
    WarnOfSkippedFrames();
    const RunSummary summary = directory_->Summary();
    const bool published = folder_.Publish(status, error);
    where_ = published ? FLAGS_output : folder_.unfinished().root();
    if (status == RunStatus::kComplete) {
      std::cout << VerdictLine(summary) << std::endl;
    }
  }

  /// Of a run that an error ended; a second error, as on a full disk, leaves
  /// what was written before.
  void WriteAfterFailure(const std::string& error) {
    try {
      WriteResults(RunStatus::kFailed, error);
    } catch (const std::exception& second) {
      LOG(WARNING) << "results cannot be written: " << second.what();
    }
  }

  std::unique_ptr<Reconstruction> work_;
  RunFolder& folder_;
  std::optional<RunDirectory> directory_;
  CheckpointSchedule schedule_;
  Stopwatch since_start_;
  Stopwatch since_checkpoint_;
  std::set<int> coarse_;  // Surfaces whose graph is coarser than planned.
  bool warned_of_depth_ = false;
  int done_ = 0;
  std::string where_;  // Folder of what was written.
  // Last: its thread uses the others.
  std::optional<ReadAhead<PreparedFrame>> frames_;
};

/// A full disk is better found before the first frame than after the last.
void CheckDisk(const TumReader& reader, const RunFolder& folder) {
  if (folder.start() != RunStart::kFresh) return;
  const PinholeCamera& camera = reader.camera();
  CheckDiskSpace(folder.unfinished().root(),
                 EstimatedBytes({std::int64_t{camera.width} * camera.height,
                                 reader.size(), FLAGS_pictures_every}));
}

void CheckOutputFlags() {
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  CheckOption(FLAGS_warped_every >= 0, "warped_every", FLAGS_warped_every,
              "a number of frames, or 0");
  CheckOption(FLAGS_pictures_every >= 0, "pictures_every", FLAGS_pictures_every,
              "a number of frames, or 0");
  CheckOption(FLAGS_checkpoint_every >= -1, "checkpoint_every",
              FLAGS_checkpoint_every, "a number of frames, 0 or -1");
  CheckOption(!FLAGS_keep_checkpoints || FLAGS_checkpoint_every > 0,
              "keep_checkpoints", "true", "--checkpoint_every above 0");
  CheckNotInOutput("sequence", FLAGS_sequence);
  CheckNotInOutput("masks", FLAGS_masks);
  CheckNotInOutput("from", FLAGS_from);
  CheckOption(!FLAGS_keep_same || FLAGS_overwrite, "keep_same", "true",
              "--overwrite beside it");
}

int RunSequence() {
  ApplySetFlag();
  const TumReaderOptions reading = ReaderOptionsFromFlags();
  const PipelineOptions options = PipelineOptionsFromFlags();
  if (FLAGS_print_identity) {
    std::cout << IdentityText(
        IdentityFromFlags(TumReader(FLAGS_sequence, reading)));
    return kExitDone;
  }
  CheckOutputFlags();
  const ThreadLimit threads;
  SetBlasThreads(1);
  const auto make = [&] {
    return std::make_unique<Reconstruction>(reading, options);
  };
  std::unique_ptr<Reconstruction> work = make();
  RunFolder folder = OpenRunFolder(IdentityFromFlags(work->reader));
  if (folder.start() == RunStart::kFinished) {
    std::cout << FLAGS_output << ": holds the finished run of these options "
              << "and this input; nothing to do\n";
    return kExitDone;
  }
  CheckDisk(work->reader, folder);
  CatchInterruption();
  Run(std::move(work), make, &folder).Execute();
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
