#include "splitfusion/pipelines/sequence_run.h"

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/archive_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/base/process_memory.h"
#include "splitfusion/lib/base/temporary_files_folder.h"
#include "splitfusion/lib/model/surface_uncertainty.h"
#include "splitfusion/lib/page/html_report.h"
#include "splitfusion/lib/report/frame_pictures.h"
#include "splitfusion/pipelines/color_pass.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "splitfusion/pipelines/refine_pass.h"

namespace splitfusion {
namespace {

/// Of checkpoint.bin: another one with every change of what it holds.
constexpr std::uint32_t kCheckpointVersion = SplitFusion::kStateVersion;

/// Frames after which freed memory goes back to the system.
constexpr int kFramesOfFreedMemory = 100;  // Speed.

/// Somebody wants a run to stop.
struct Interruption {};

/// Indices of frames without usable images.
std::vector<int> SkippedFrames(const ImageFolderReader& reader) {
  std::vector<int> frames;
  for (const BadFrame& bad : reader.skipped()) frames.push_back(bad.index);
  return frames;
}

}  // namespace

SequenceRun::SequenceRun(std::unique_ptr<Reconstruction> work,
                         const Maker& make, RunFolder* folder,
                         SequenceRunOptions options, SequenceRunHooks hooks)
    : work_(std::move(work)),
      make_(make),
      folder_(*folder),
      options_(std::move(options)),
      hooks_(std::move(hooks)),
      schedule_(options_.checkpoint_every) {
  if (folder_.start() == RunStart::kResumed && !Resume()) work_ = make_();
  if (!directory_) {
    OpenDirectory(/*goes_on=*/false);
    if (!options_.from.run.empty()) StartFromOther();
  }
  if (!folder_.note().empty()) Warn(folder_.root() + ": " + folder_.note());
  done_before_ = done_;
  WriteCalibration(directory_->paths().Calibration(),
                   work_->reader.calibration());
  WriteColorRegistration();
  const std::string times_note = work_->reader.TimesNote();
  if (!times_note.empty()) Warn(times_note);
  if (!work_->rows_note.empty()) {
    Warn(work_->rows_note + "; undone (--rolling_shutter, docs/your_data.md)");
  }
  frames_.emplace([this] { return ReadNext(); }, options_.reads_ahead);
}

SequenceRun::~SequenceRun() = default;

void SequenceRun::Execute() {
  try {
    ProcessFrames();
    if (FindLoops()) {
      BeginAnew();
      ProcessFrames();
    }
    if (WriteEnd()) return;
  } catch (const std::exception& error) {
    folder_.CheckHeld();  // If it is gone, that is why no file can be written.
    folder_.RecordFailure(error.what());
    throw;
  }
  throw std::runtime_error("interrupted after " + std::to_string(done_) +
                           " of " + std::to_string(work_->reader.size()) +
                           " frames; what was computed is in " + where_ +
                           ", and the same command goes on");
}

void SequenceRun::WriteColorRegistration() const {
  const std::optional<ColorCamera>& camera = work_->fusion.color_camera();
  if (!camera) return;
  WriteColorCamera(directory_->paths().ColorCamera(), *camera);
  if (work_->note.empty()) return;
  Warn(work_->note + "; registered (--color_camera, docs/your_data.md)");
}

void SequenceRun::OpenDirectory(bool goes_on) {
  directory_.emplace(folder_.unfinished().root(), options_.facts, goes_on);
}

/// Goes on from the checkpoint; false if that is of no use.
bool SequenceRun::Resume() {
  try {
    OpenDirectory(/*goes_on=*/true);
    ReadArchiveFile(folder_.unfinished().Checkpoint(), kCheckpointVersion,
                    [&](ArchiveReader* archive) { Serialize(archive); });
  } catch (const TemporaryFileError&) {
    throw;  // The checkpoint is as good as it was.
  } catch (const InputError& error) {
    directory_.reset();
    done_ = 0;
    closure_ = {};
    coarse_.clear();
    heard_terms_.clear();
    warned_of_depth_ = false;
    folder_.StartAfresh(std::string("begins anew: ") + error.what());
    return false;
  }
  work_->reader.SkipTo(done_);
  folder_.RecordResumption(done_);
  if (hooks_.tell) {
    hooks_.tell(folder_.root() + ": goes on after " + std::to_string(done_) +
                " of " + std::to_string(work_->reader.size()) + " frames");
  }
  return true;
}

void SequenceRun::StartFromOther() {
  ReadArchiveFile(RunPaths(options_.from.run).KeptCheckpoint(options_.from.at),
                  kCheckpointVersion,
                  [&](ArchiveReader* archive) { SerializeState(archive); });
  if (done_ >= work_->reader.size()) {
    throw InputError(options_.from.run + ": its state is that after " +
                     std::to_string(done_) +
                     " frames of this run: expected one before the last of " +
                     std::to_string(work_->reader.size()));
  }
  work_->reader.SkipTo(done_);
}

/// All that later frames and results depend on.
template <typename Archive>
void SequenceRun::Serialize(Archive* archive) {
  (*archive)(closure_, done_, coarse_, heard_terms_, warned_of_depth_,
             work_->fusion, *directory_);
}

/// The state alone, without what this run reported.
template <typename Archive>
void SequenceRun::SerializeState(Archive* archive) {
  ExpectSame(archive, "first_frame", work_->reader.options().first_frame);
  (*archive)(done_, work_->fusion);
}

void SequenceRun::SaveCheckpoint() {
  const Stopwatch writing;
  if (options_.keep_checkpoints) {
    const ReaderOptions& reading = work_->reader.options();
    WriteArchiveFile(folder_.unfinished().KeptCheckpoint(
                         reading.first_frame + done_ * reading.frame_step),
                     kCheckpointVersion,
                     [&](ArchiveWriter* archive) { SerializeState(archive); });
  }
  WriteArchiveFile(folder_.unfinished().Checkpoint(), kCheckpointVersion,
                   [&](ArchiveWriter* archive) { Serialize(archive); });
  schedule_.Saved(writing.Seconds());
  directory_->AddWritingSeconds(writing.Seconds());
  since_checkpoint_.Restart();
}

/// All frames, or those before an interruption.
void SequenceRun::ProcessFrames() {
  try {
    while (!(hooks_.interrupted && hooks_.interrupted()) && ProcessNext()) {
    }
    if (done_ == work_->reader.size()) CheckReconstructed();
  } catch (const std::exception& error) {
    // What was computed until then is kept.
    WriteFailure(error.what());
    throw;
  }
}

bool SequenceRun::ProcessNext() {
  const Stopwatch frame_time;
  if (done_ % kFramesOfFreedMemory == 0) ReturnFreedMemory();
  std::optional<PreparedFrame> prepared = frames_->Next();
  if (!prepared) return false;
  const Frame frame = prepared->frame;
  if (options_.recorder) options_.recorder->BeginFrame(frame.index);
  if (options_.solutions) options_.solutions->BeginFrame(frame.index);
  FrameReport report = work_->fusion.ProcessFrame(std::move(*prepared));
  // Less than the sum of its parts: reading overlaps with the frame before.
  report.total_seconds = frame_time.Seconds();
  folder_.CheckHeld();
  const Stopwatch judging;
  WriteUncertainties(&report);
  directory_->AddWritingSeconds(judging.Seconds());
  directory_->AddFrame(report, work_->fusion.trajectory().back());
  WarnOfMissingDepth(frame);
  WarnOfLostSurfaces(report);
  WarnOfCoarseGraphs(report.frame);
  HearTerms(report);
  const Stopwatch writing;
  WritePictures(frame, report.frame);
  WriteProblems(report.frame);
  directory_->AddWritingSeconds(writing.Seconds());
  ++done_;
  const bool more = done_ < work_->reader.size();
  if (schedule_.IsDue(since_checkpoint_.Seconds()) && more) SaveCheckpoint();
  ShowProgress();
  return true;
}

std::optional<PreparedFrame> SequenceRun::ReadNext() {
  const Stopwatch reading;
  std::optional<Frame> frame = work_->reader.Next();
  if (!frame) return std::nullopt;
  const double seconds = reading.Seconds();
  const auto closed = closure_.world_from_camera.find(frame->index);
  if (closed != closure_.world_from_camera.end()) {
    frame->world_from_camera = closed->second;
  }
  PreparedFrame prepared = work_->fusion.Prepare(*frame);
  prepared.read_seconds += seconds;
  return prepared;
}

void SequenceRun::WritePictures(const Frame& frame, int index) const {
  if (options_.write_masks) {
    WriteMask(directory_->paths(), frame.stem, work_->fusion.labels());
  }
  const int every = options_.pictures_every;
  if (every == 0 || index % every != 0) return;
  const SceneRendering scene =
      RenderScene(work_->fusion.surfaces(), work_->fusion.camera(),
                  work_->fusion.options().ray_cast);
  cv::Mat depth;
  cv::extractChannel(scene.map.points, depth, 2);
  WriteFramePictures(directory_->paths(), index,
                     {frame.color, frame.depth, work_->fusion.labels(),
                      scene.map.color, depth, scene.map.normals});
}

void SequenceRun::WriteProblems(int index) {
  if (!options_.recorder) return;
  options_.recorder->EndFrame(
      [&](const FrozenProblem& problem, bool first) {
        WriteFrozenProblem(
            directory_->paths().Problem(index, problem.surface, first),
            problem);
      },
      [&](int surface, const std::string& reason) {
        if (!not_frozen_.emplace(surface, reason).second) return;
        Warn("frame " + std::to_string(index) + ": surface " +
             std::to_string(surface) + " is not frozen: " + reason +
             "; said once");
      });
}

/// Of the surfaces that were tracked, but for a ray cast background, which has
/// no mesh before the end; says in the report how well they are held.
void SequenceRun::WriteUncertainties(FrameReport* report) const {
  if (!options_.solutions) return;
  for (SurfaceReport& object : report->surfaces) {
    const SolvedProblem* solved = options_.solutions->Find(object.id);
    const auto surface = work_->fusion.surfaces().find(object.id);
    // One that ended in this frame is there no more.
    if (solved == nullptr || surface == work_->fusion.surfaces().end() ||
        surface->second->is_ray_cast() || !object.event.empty() ||
        object.state != TrackState::kTracked) {
      continue;
    }
    const SurfaceUncertainty found =
        EstimateUncertainty(*surface->second, *solved);
    object.hold = {found.nodes, found.held_by_prior, Median(found.Sigmas())};
    WriteUncertainty(directory_->paths().Uncertainty(report->frame, object.id),
                     found);
  }
}

void SequenceRun::ShowProgress() const {
  if (!hooks_.shown) return;
  RunProgress progress;
  progress.done = done_;
  progress.total = work_->reader.size();
  progress.surfaces = static_cast<int>(work_->fusion.surfaces().size());
  progress.seconds_left = since_start_.Seconds() / (done_ - done_before_) *
                          (progress.total - done_);
  hooks_.shown(progress);
}

/// @throw Interruption
void SequenceRun::ShowPass(RunPass pass, int done, int total) const {
  if (hooks_.interrupted && hooks_.interrupted()) throw Interruption();
  if (!hooks_.shown) return;
  hooks_.shown(
      {pass, done, total, static_cast<int>(work_->fusion.surfaces().size())});
}

/// Whether the poses of the camera change by more than a voxel where it came
/// back to what it knew: then closure_ holds better ones.
bool SequenceRun::FindLoops() {
  const PipelineOptions& options = work_->fusion.options();
  const bool open = options.close_loops && options_.from.run.empty() &&
                    work_->reader.options().trajectory.empty() &&
                    closure_.report.key_frames == 0;  // Not looked for yet.
  if (!open || done_ < work_->reader.size()) return false;
  closure_ = work_->fusion.CloseCameraLoops();
  LoopReport& report = closure_.report;
  report.fused_anew =
      report.largest_change > options.background.tsdf.voxel_size;
  if (!report.fused_anew) closure_.world_from_camera.clear();
  return report.fused_anew;
}

/// All frames will be processed again, with the poses of closure_; what is
/// there of them is removed. A checkpoint says so from now on.
void SequenceRun::BeginAnew() {
  if (hooks_.tell) {
    hooks_.tell(folder_.root() + ": loops of the camera are closed, which " +
                "moves what it saw by up to " +
                std::to_string(closure_.report.largest_change) +
                " m: all frames are fused anew");
  }
  frames_.reset();  // Its thread uses the others.
  const UsualMisfit misfit = work_->fusion.camera_misfit();
  const RunTime time_before = directory_->time_before();
  work_.reset();
  directory_.reset();
  work_ = make_();
  work_->fusion.set_camera_misfit(misfit);
  for (const char* name : {"checkpoints", "masks", "pictures", "problems",
                           "solver", "uncertainty"}) {
    std::filesystem::remove_all(
        std::filesystem::path(folder_.unfinished().root()) / name);
  }
  OpenDirectory(/*goes_on=*/false);
  directory_->set_time_before(time_before);
  coarse_.clear();
  done_ = done_before_ = 0;
  since_start_.Restart();
  if (options_.checkpoint_every >= 0) {
    SaveCheckpoint();
  } else {
    std::filesystem::remove(folder_.unfinished().Checkpoint());
  }
  frames_.emplace([this] { return ReadNext(); }, options_.reads_ahead);
}

/// @throw InputError if there was nothing to reconstruct.
void SequenceRun::CheckReconstructed() const {
  if (!work_->fusion.surfaces().empty()) return;
  throw InputError(work_->reader.folder() +
                   ": nothing to reconstruct in any of " +
                   std::to_string(done_) + " frames: " + ExpectedDepth());
}

/// Whether the run is complete.
bool SequenceRun::WriteEnd() {
  if (done_ == work_->reader.size()) {
    WarnOfUnknownClasses();
    WarnOfSilentTerms();
    try {
      WriteResults(RunStatus::kComplete);
      return true;
    } catch (const Interruption&) {  // Of a pass over all frames.
    }
  }
  SaveCheckpoint();
  WriteResults(RunStatus::kIncomplete);
  return false;
}

void SequenceRun::WriteResults(RunStatus status, const std::string& error) {
  folder_.CheckHeld();
  WriteSurfaces(status == RunStatus::kComplete);
  directory_->Finish({status, error, folder_.marker().resumed_at,
                      SkippedFrames(work_->reader), closure_.report},
                     WriteHtmlReport);
  WarnOfSkippedFrames();
  const bool published = folder_.Publish(status, error);
  where_ = published ? folder_.root() : folder_.unfinished().root();
}

/// `all_frames`: the passes over all of them are made, too. They are not where
/// a run stops before its end: it goes on later, or has to stop soon.
void SequenceRun::WriteSurfaces(bool all_frames) {
  frames_.reset();  // What reads ahead may change what the reader gives.
  Stopwatch stopwatch;
  const SplitFusion& fusion = work_->fusion;
  if (all_frames) work_->fusion.PlaceLostCamera();
  work_->fusion.Finish();
  SurfaceModels models = ModelsOf(fusion);
  std::error_code ignored;  // That of an end before this one.
  std::filesystem::remove(directory_->paths().Refinement(), ignored);
  std::filesystem::remove(directory_->paths().HiddenDeviations(), ignored);
  directory_->AddWritingSeconds(stopwatch.Restart());
  if (all_frames && fusion.options().hidden.refine) RefineModels(&models);
  directory_->AddRefiningSeconds(stopwatch.Restart());
  ResidualsById residuals;
  if (all_frames && fusion.options().best_view_colors) {
    ColorModels(&models, &residuals);
  }
  directory_->AddColoringSeconds(stopwatch.Restart());
  if (all_frames) directory_->WriteTrajectory(fusion.trajectory());
  for (const auto& [id, surface] : fusion.surfaces()) {
    const SurfaceModel& model = models.at(id);
    const StretchedArea stretch =
        WriteSurface(directory_->paths(), *surface, model, options_.warped);
    if (residuals.count(id) > 0) {
      WriteResiduals(directory_->paths().Residuals(id, surface->label()),
                     residuals[id]);
    }
    directory_->SetWritten(
        id, {model.graph.size(), static_cast<int>(model.mesh.vertices.size()),
             stretch});
  }
  directory_->AddWritingSeconds(stopwatch.Restart());
}

/// Finds the motions of what was hidden, and reports on them.
void SequenceRun::RefineModels(SurfaceModels* models) const {
  const RefinementReport report = RefineModelMotions(
      work_->fusion,
      [this](int done, int total) {
        ShowPass(RunPass::kRefining, done, total);
      },
      models);
  report.Write(directory_->paths());
}

/// Colours vertices from the frames that show them well, and finds how far
/// surfaces lie from the live depth. What was tracked is not lost for a trouble
/// with colours.
void SequenceRun::ColorModels(SurfaceModels* models,
                              ResidualsById* residuals) const {
  try {
    const std::string trouble = ColorFromBestViews(
        work_->reader, done_, work_->fusion, options_.reads_ahead,
        [this](int done) { ShowPass(RunPass::kColoring, done, done_); }, models,
        residuals);
    if (!trouble.empty()) Warn(trouble);
  } catch (const std::exception& error) {
    Warn(std::string("vertices keep the colours of fusion: ") + error.what());
  }
}

/// Of a run that an error ended; a second error, as on a full disk, leaves
/// what was written before.
void SequenceRun::WriteFailure(const std::string& error) {
  try {
    WriteResults(RunStatus::kFailed, error);
  } catch (const std::exception& second) {
    Warn(std::string("results cannot be written: ") + second.what());
  }
}

}  // namespace splitfusion
