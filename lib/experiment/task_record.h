#ifndef SPLITFUSION_LIB_EXPERIMENT_TASK_RECORD_H_
#define SPLITFUSION_LIB_EXPERIMENT_TASK_RECORD_H_

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/figures.h"
#include "splitfusion/lib/experiment/task.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// Where a task is.
enum class TaskState {
  kWaiting,      ///< Was never started.
  kStarted,      ///< At work, or stopped in the middle.
  kChecking,     ///< Was complete; sf_run looks whether it still is.
  kComplete,     ///< sf_run and sf_evaluate have ended well.
  kFailed,       ///< sf_run has not.
  kUnevaluated,  ///< sf_run has, sf_evaluate has not.
  kRecorded,     ///< A file of rows has its figures; see RowFile.
};

/// Text in task.json.
std::string ToString(TaskState state);

/// What a run has used from its first frame to its last; NaN where that was not
/// measured, as of a run that was killed and went on.
struct RunCost {
  double wall_seconds = std::numeric_limits<double>::quiet_NaN();  ///< Clock.
  /// User and system, of all threads.
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();
  /// Largest resident size.
  double peak_memory_bytes = std::numeric_limits<double>::quiet_NaN();
};

/// What was done for a task: task.json of its folder.
struct TaskRecord {
  Task task;                              ///< What was to be done.
  TaskState state = TaskState::kWaiting;  ///< Where it is.
  int attempts = 0;                       ///< How often it was started.
  int exit_code = 0;                      ///< Of what failed, or 0.
  std::vector<std::string> last_lines;    ///< Of what failed, on stderr.
  std::string reason;          ///< Why it was done again; may be empty.
  std::string run_id;          ///< Of the result that counts.
  std::string evaluated_id;    ///< Run that evaluation.json is about.
  NamedValues evaluated_by;    ///< See EvaluationParts().
  std::string evaluation;      ///< Hash of what sf_evaluate wrote then.
  RunCost cost;                ///< Of the run that counts.
  std::string host;            ///< That worked on it last.
  std::string started;         ///< UTC, ISO 8601.
  std::string ended;           ///< The same; empty while it is at work.
  std::string identity;        ///< Of the run that counts.
  NamedValues identity_parts;  ///< Of a recorded one.
  Figures figures;             ///< Of a recorded one.

  /// The last of `last_lines`; empty if there is none.
  std::string Error() const;
};

/// Reads FOLDER/task.json; empty if it is missing or damaged, or of a task of
/// another name: a folder that was copied is not a further run.
std::optional<TaskRecord> ReadTaskRecord(const std::string& folder);

/// Writes FOLDER/task.json.
///
/// @throw InputError if it cannot be written.
void WriteTaskRecord(const std::string& folder, const TaskRecord& record);

/// Now, UTC, as 2026-01-31T12:00:00.000Z.
std::string TimeText();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_TASK_RECORD_H_
