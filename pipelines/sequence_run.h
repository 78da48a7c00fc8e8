#ifndef SPLITFUSION_PIPELINES_SEQUENCE_RUN_H_
#define SPLITFUSION_PIPELINES_SEQUENCE_RUN_H_

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "splitfusion/lib/base/read_ahead.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/problem_recorder.h"
#include "splitfusion/lib/energy/solution_recorder.h"
#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/lib/render/depth_residuals.h"
#include "splitfusion/lib/report/checkpoint_schedule.h"
#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/report/run_folder.h"
#include "splitfusion/lib/report/surface_output.h"
#include "splitfusion/pipelines/loop_closure.h"
#include "splitfusion/pipelines/prepared_frame.h"

namespace splitfusion {

struct Reconstruction;

/// A state of another run to begin with.
struct OtherState {
  std::string run;  ///< Run directory with checkpoints; empty: none.
  int at = 0;       ///< First frame after that state, index in the sequence.
};

/// What a run writes besides its report, and how its state is kept.
struct SequenceRunOptions {
  WarpedOutput warped;            ///< Warped meshes.
  int pictures_every = 10;        ///< Flag: of every n-th frame; 0 = none.
  bool write_masks = true;        ///< Refined masks of every frame.
  int checkpoint_every = 0;       ///< Flag: see CheckpointSchedule.
  bool keep_checkpoints = false;  ///< All of them, for OtherState.
  bool reads_ahead = true;        ///< The next frame, in a thread of its own.
  OtherState from;                ///< Where to begin.
  RunFacts facts;                 ///< What the run was made with.
  /// What keeps the problems of the solvers of Reconstruction, to be written;
  /// may be null.
  std::shared_ptr<ProblemRecorder> recorder;
  /// What keeps their solutions, for the uncertainty of the surfaces; may be
  /// null.
  std::shared_ptr<SolutionRecorder> solutions;
};

/// What a run does with its frames, one pass after the other.
enum class RunPass {
  kTracking,  ///< Tracks and fuses them.
  kRefining,  ///< Finds hidden motions, surface by surface.
  kColoring,  ///< Colours vertices from them.
};

/// How far a run is.
struct RunProgress {
  RunPass pass = RunPass::kTracking;  ///< The one in hand.
  int done = 0;                       ///< Frames, or surfaces (kRefining).
  int total = 0;                      ///< Likewise.
  int surfaces = 0;                   ///< So far.
  double seconds_left = 0;  ///< Of tracking, at the pace so far; else 0.
};

/// What a run tells its caller; all may be empty.
struct SequenceRunHooks {
  std::function<bool()> interrupted;              ///< Whether to stop here.
  std::function<void(const RunProgress&)> shown;  ///< After every frame.
  std::function<void(const std::string&)> warn;   ///< A line.
  std::function<void(const std::string&)> tell;   ///< A line.
};

/// One run of the method over a sequence into a run directory, with
/// checkpoints: what tools/sf_run does once its flags are read.
class SequenceRun {
 public:
  /// Makes what a run computes with, before its first frame.
  using Maker = std::function<std::unique_ptr<Reconstruction>()>;

  /// Opens the directory, goes on from a checkpoint if `folder` holds one of
  /// use, or from options.from.
  ///
  /// @param work what to compute with.
  /// @param make makes `work` anew, where a checkpoint turns out to be broken,
  ///     or loops are closed.
  /// @param folder where to write, not finished; must outlive this.
  /// @throw InputError if a file cannot be written or read.
  SequenceRun(std::unique_ptr<Reconstruction> work, const Maker& make,
              RunFolder* folder, SequenceRunOptions options,
              SequenceRunHooks hooks = {});

  ~SequenceRun();  ///< Where Reconstruction is known.

  /// All frames and the results; all frames again if the camera's loops are
  /// closed by more than a voxel of the background. What was computed is kept,
  /// and the run marked as failed or incomplete, if it ends before.
  ///
  /// @throw InputError if a frame or a result cannot be read or written, or if
  ///     there was nothing to reconstruct.
  /// @throw std::runtime_error if it was interrupted.
  void Execute();

  /// Of the frames so far.
  RunSummary Summary() const { return directory_->Summary(); }

 private:
  void OpenDirectory(bool goes_on);
  void WriteColorRegistration() const;
  bool Resume();
  void StartFromOther();
  template <typename Archive>
  void Serialize(Archive* archive);
  template <typename Archive>
  void SerializeState(Archive* archive);
  void SaveCheckpoint();

  void ProcessFrames();
  bool ProcessNext();
  std::optional<PreparedFrame> ReadNext();
  void WritePictures(const Frame& frame, int index) const;
  void WriteProblems(int index);
  void WriteUncertainties(FrameReport* report) const;
  void ShowProgress() const;
  void ShowPass(RunPass pass, int done, int total) const;

  bool FindLoops();
  void BeginAnew();

  void CheckReconstructed() const;
  bool WriteEnd();
  void WriteResults(RunStatus status, const std::string& error = "");
  /// All surfaces; `all_frames`: with hidden motions and colours that take
  /// passes over all of them.
  void WriteSurfaces(bool all_frames);
  void RefineModels(SurfaceModels* models) const;
  void ColorModels(SurfaceModels* models, ResidualsById* residuals) const;
  void WriteFailure(const std::string& error);

  std::string ExpectedDepth() const;
  void WarnOfMissingDepth(const Frame& frame);
  void WarnOfLostSurfaces(const FrameReport& report) const;
  void WarnOfCoarseGraphs(int frame);
  void WarnOfSkippedFrames() const;
  /// Of options of terms for classes of which no surface is.
  void WarnOfUnknownClasses() const;
  /// Notes which terms have residuals.
  void HearTerms(const FrameReport& report);
  /// Of terms beside those of the default energy that had none.
  void WarnOfSilentTerms() const;
  void Warn(const std::string& line) const;

  std::unique_ptr<Reconstruction> work_;
  Maker make_;
  RunFolder& folder_;
  SequenceRunOptions options_;
  SequenceRunHooks hooks_;
  std::optional<RunDirectory> directory_;
  CheckpointSchedule schedule_;
  Stopwatch since_start_;
  Stopwatch since_checkpoint_;
  std::set<int> coarse_;  // Surfaces whose graph is coarser than planned.
  std::set<std::string> heard_terms_;                 // Those with residuals.
  std::set<std::pair<int, std::string>> not_frozen_;  // Surface and why.
  bool warned_of_depth_ = false;
  LoopClosure closure_;  // Its poses are given once all is fused anew.
  int done_ = 0;
  int done_before_ = 0;  // By the run this one goes on with.
  std::string where_;    // Folder of what was written.
  // Last: its thread uses the others.
  std::optional<ReadAhead<PreparedFrame>> frames_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_SEQUENCE_RUN_H_
