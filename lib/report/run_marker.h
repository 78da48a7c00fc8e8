#ifndef SPLITFUSION_LIB_REPORT_RUN_MARKER_H_
#define SPLITFUSION_LIB_REPORT_RUN_MARKER_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/base/owned_files.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// How far a run has come.
enum class RunStatus {
  kRunning,     ///< It goes on, or was killed.
  kComplete,    ///< All frames; the one success.
  kIncomplete,  ///< Interrupted; what was computed is there.
  kFailed,      ///< An error ended it; RunMarker::error says which.
};

/// "running", "complete", "incomplete", "failed".
std::string ToString(RunStatus status);

/// A file of a run as it was written.
struct RunFile {
  std::uint64_t bytes = 0;  ///< Size.
  std::string xxh3;         ///< HashOfFile().
};

/// Where a run is on its way from RUN/unfinished to its place.
enum class PublishingPhase {
  kNone,      ///< Not on its way.
  kRemoving,  ///< Files of an older result are being deleted.
  kMoving,    ///< They are gone; its own are being renamed.
};

/// Content of RUN/run.json: by this file a folder is known to be a run, and
/// what in it is the run's. Format: docs/report_format.md.
struct RunMarker {
  std::string id;                          ///< Of this very run, RandomId().
  RunStatus status = RunStatus::kRunning;  ///< How far it has come.
  std::string error;                       ///< Of a failed run, one line.
  std::vector<int> resumed_at;             ///< Frames from which it went on.
  RunIdentity identity;                    ///< What decides the result.
  /// What the run wrote, by path relative to it; once it has ended.
  std::map<std::string, RunFile> files;

  PublishingPhase phase = PublishingPhase::kNone;  ///< Of putting in place.

  /// The same as a list of what may be deleted.
  OwnedFileList Owned() const;
  /// Whether the run has the same result and the same outputs.
  bool IsSame(const RunIdentity& other) const;
};

/// The marker of a folder; empty if it has none.
///
/// @throw InputError if it is broken.
std::optional<RunMarker> ReadRunMarker(const std::string& folder);

/// Replaces the marker. @throw InputError if it cannot be written.
void WriteRunMarker(const std::string& folder, const RunMarker& marker);

/// All regular files below a folder with sizes and hashes, but for the marker
/// and what `left_out` names (relative paths).
std::map<std::string, RunFile> ListRunFiles(
    const std::string& folder, const std::vector<std::string>& left_out);

/// Checks a file of a run against the marker of its folder. Files and folders
/// without an entry in a marker pass.
///
/// @throw InputError if the file is missing or not as it was written.
void CheckRunFile(const RunMarker& marker, const std::string& folder,
                  const std::string& path);

/// Why a run is not whole any more: the first of its files that is missing or
/// of another size; empty if there is none. Nothing is read. An evaluation,
/// which can be made again, does not count.
std::string FindMissing(const RunMarker& marker, const std::string& folder);

/// Adds a file of the folder to its marker, or replaces its entry; nothing if
/// the folder has no marker.
void AddRunFile(const std::string& folder, const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_RUN_MARKER_H_
