#ifndef SPLITFUSION_LIB_REPORT_RUN_FOLDER_H_
#define SPLITFUSION_LIB_REPORT_RUN_FOLDER_H_

#include <optional>
#include <string>

#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// What may be done with what a folder holds.
struct RunFolderOptions {
  bool overwrite = false;  ///< A result of other options is replaced.
  bool keep_same = false;  ///< But not one of the same identity and outputs.
  bool resume = true;      ///< An unfinished run of the same identity goes on.
};

/// How a run begins.
enum class RunStart {
  kFinished,  ///< The result is there already: nothing is to be done.
  kFresh,     ///< With the first frame.
  kResumed,   ///< From the checkpoint of unfinished().
};

/// Why no run can begin or go on in a folder, whatever its options: a marker is
/// damaged, or files lie there that no marker names. Empty if one can.
std::string RunFolderDamage(const std::string& root);

/// A run directory while a run goes on in it. The run writes into
/// RUN/unfinished, a run directory of its own, and is put into place when it
/// has ended: files of an older result are deleted by the list in its marker,
/// then the new ones are renamed. Whatever else lies in RUN or RUN/unfinished
/// stays. A program that is killed at any moment leaves a state from which the
/// next one goes on, and an older result until the new one is whole.
class RunFolder {
 public:
  /// Makes `root`, locks it, mends what a killed program left, and decides how
  /// to begin.
  ///
  /// @throw InputError if another process works on the folder, if it holds what
  ///     no run wrote, or a run of another identity and not `overwrite`.
  RunFolder(std::string root, RunIdentity identity,
            const RunFolderOptions& options);

  /// How to begin.
  RunStart start() const { return start_; }
  /// Why an older result is replaced or an unfinished run is not gone on with;
  /// may be empty.
  const std::string& note() const { return note_; }
  /// The run directory.
  const std::string& root() const { return root_; }
  /// Where the run writes.
  const RunPaths& unfinished() const { return unfinished_; }
  /// The marker of this run (of the finished one if there is one).
  const RunMarker& marker() const { return marker_; }

  /// Begins with the first frame after all, for want of a usable checkpoint.
  void StartAfresh(const std::string& why);
  /// States that the run goes on from `frame`.
  void RecordResumption(int frame);

  /// @throw InputError if the folder was removed or another process took it
  /// over.
  void CheckHeld() const;

  /// Ends the run. A complete one takes the place of an older result; others
  /// are put where no complete one is, and what is needed to go on stays in
  /// unfinished(). False if an older complete result was kept instead.
  bool Publish(RunStatus status, const std::string& error = "");
  /// States in the marker that the run failed, where that can be written;
  /// nothing is put into place. For errors while results are written.
  void RecordFailure(const std::string& error) noexcept;

 private:
  void Lock();
  void Recover();
  void Decide(const RunFolderOptions& options);
  void DecideBesides(const std::optional<RunMarker>& published,
                     const std::optional<RunMarker>& begun,
                     const RunFolderOptions& options);
  void Begin();
  void Resume(RunMarker begun);
  void RemoveUnfinished();
  void PutInPlace(RunMarker marker);

  std::string root_;
  RunPaths paths_;
  RunPaths unfinished_;
  RunIdentity identity_;
  std::optional<DirectoryLock> lock_;
  RunStart start_ = RunStart::kFresh;
  std::string note_;
  RunMarker marker_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_FOLDER_H_
