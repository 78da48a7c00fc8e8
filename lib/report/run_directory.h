#ifndef SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_
#define SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_

#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/report/run_summary.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// What a run was made with.
struct RunFacts {
  std::string preset;   ///< Name of the preset.
  std::string options;  ///< Flagfile text that repeats the run.
  std::map<std::string, std::string> versions;  ///< LibraryVersions().
  Stopwatch since_start = {};  ///< Of all that it took, in this process.
};

/// What a run took, seconds.
struct RunTime {
  double wall = 0;  ///< By the clock.
  double cpu = 0;   ///< Of all threads.
};

/// How a run ended.
struct RunEnding {
  RunStatus status = RunStatus::kComplete;  ///< Only this is a success.
  std::string error;                        ///< Of a failed run, one line.
  std::vector<int> resumed_at;              ///< Frames from which it went on.
  std::vector<int> skipped_frames;          ///< Left out: images not usable.
  LoopReport loops = {};                    ///< Of the camera's path.
};

/// Whether the summary of a run is there and says that it is complete.
bool IsComplete(const RunPaths& paths);

/// Writes the report of a run while it happens: after every frame the lines of
/// that frame are on disk, so a crash leaves the account of all frames before.
/// RunFolder says where a run writes, and puts it into place.
/// Formats: docs/report_format.md.
class RunDirectory {
 public:
  /// Writes options.flags and the heads of the streams into `root`, which is
  /// made if it is missing. `goes_on`: streams that are there are kept, for
  /// Serialize() to cut them.
  ///
  /// @throw InputError if a file cannot be written.
  RunDirectory(const std::string& root, RunFacts facts, bool goes_on = false);

  /// Saves or restores what was reported so far, see lib/base/archive.h. The
  /// streams are cut to what they held then.
  ///
  /// @throw InputError if a stream holds less than it did, or a mask, a picture
  ///     or another file that lay there then is missing or shorter.
  template <typename Archive>
  void Serialize(Archive* archive);

  /// Where everything of this run lies.
  const RunPaths& paths() const { return paths_; }

  /// Appends one frame to frames.jsonl, iterations.csv and trajectory.txt, and
  /// writes solver/FRAME.txt if a solver report carries Ceres' full text.
  ///
  /// @throw InputError if a file cannot be written.
  void AddFrame(const FrameReport& report, const TimedPose& pose);

  /// Writes trajectory.txt anew, once all frames are known: of the poses the
  /// last ones, those of the frames that were added.
  ///
  /// @throw InputError if it cannot be written.
  void WriteTrajectory(const Trajectory& trajectory) const;

  /// Counts time spent on writing outside of this class (meshes, pictures) to
  /// `seconds_writing`.
  void AddWritingSeconds(double seconds) { seconds_writing_ += seconds; }

  /// Counts time to `seconds_refining`, at the end of a run.
  void AddRefiningSeconds(double seconds) { seconds_refining_ += seconds; }

  /// Counts time to `seconds_coloring`, likewise.
  void AddColoringSeconds(double seconds) { seconds_coloring_ += seconds; }

  /// States what was written of a surface at the end.
  void SetWritten(int id, const WrittenSurface& written) {
    builder_.SetWritten(id, written);
  }

  /// What the run took in processes before this one, from which it was resumed.
  const RunTime& time_before() const { return time_before_; }
  /// Takes it over from an earlier directory of the same run, whose frames are
  /// processed anew.
  void set_time_before(const RunTime& time) { time_before_ = time; }

  /// Summary of the frames so far.
  RunSummary Summary() const;

  /// Writes what people look at, given the value of summary.json.
  using PageWriter = std::function<void(const RunPaths& paths,
                                        const nlohmann::ordered_json& summary)>;

  /// Calls `write_page` and writes summary.json, the last file of a run. The
  /// ending stands in both. @throw InputError if a file cannot be written.
  void Finish(const RunEnding& ending = {},
              const PageWriter& write_page = {}) const;

 private:
  /// The streams with their paths.
  std::vector<std::pair<std::string, std::ofstream*>> Streams();
  void WriteHeads();
  /// With what the run had taken before it was resumed.
  RunTime Time() const;

  RunPaths paths_;
  RunFacts facts_;
  SummaryBuilder builder_;
  double seconds_writing_ = 0;
  double seconds_refining_ = 0;
  double seconds_coloring_ = 0;
  RunTime time_before_;
  std::ofstream frames_;
  std::ofstream iterations_;
  std::ofstream trajectory_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_DIRECTORY_H_
