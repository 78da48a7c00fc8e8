#ifndef SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_
#define SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_

#include <fstream>
#include <map>
#include <string>

#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/report/run_summary.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// What a run was made with.
struct RunFacts {
  std::string preset;   ///< Name of the preset.
  std::string options;  ///< Flagfile text that repeats the run.
  std::map<std::string, std::string> versions;  ///< LibraryVersions().
};

/// Removes what a run leaves in its directory (see RunPaths) and nothing else.
/// A missing directory is fine.
void ClearRun(const RunPaths& paths);

/// Whether the summary of a run is there and says that it is complete.
bool IsComplete(const RunPaths& paths);

/// Writes the report of a run while it happens: after every frame the lines of
/// that frame are on disk, so a crash leaves the account of all frames before.
/// Formats: docs/report_format.md.
class RunDirectory {
 public:
  /// Creates `root` with options.flags and the heads of the streams. With
  /// `overwrite` an earlier run in it is cleared; log files (*.log) never
  /// count.
  ///
  /// @throw InputError if `root` is not empty (and not `overwrite`), not a
  ///     directory, or not writable.
  RunDirectory(const std::string& root, bool overwrite, RunFacts facts);

  /// Where everything of this run lies.
  const RunPaths& paths() const { return paths_; }

  /// Appends one frame to frames.jsonl, iterations.csv and trajectory.txt, and
  /// writes solver/FRAME.txt if a solver report carries Ceres' full text.
  ///
  /// @throw InputError if a file cannot be written.
  void AddFrame(const FrameReport& report, const TimedPose& pose);

  /// Counts time spent on writing outside of this class (meshes, pictures) to
  /// `seconds_writing`.
  void AddWritingSeconds(double seconds) { seconds_writing_ += seconds; }

  /// States nodes and vertices of a surface as they were written at the end.
  void SetSurfaceSize(int id, int nodes, int vertices) {
    builder_.SetSurfaceSize(id, nodes, vertices);
  }

  /// Summary of the frames so far.
  RunSummary Summary() const;

  /// Writes summary.json and report.html; the last call of a run. `complete`:
  /// whether the whole sequence was processed; it is in the summary.
  ///
  /// @throw InputError if a file cannot be written.
  void Finish(bool complete = true) const;

 private:
  void OpenStreams();

  RunPaths paths_;
  RunFacts facts_;
  SummaryBuilder builder_;
  double seconds_writing_ = 0;
  std::ofstream frames_;
  std::ofstream iterations_;
  std::ofstream trajectory_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_
