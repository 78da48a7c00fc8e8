#include "splitfusion/lib/experiment/task_runner.h"

#include <filesystem>
#include <utility>

#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/run_state.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError(folder + ": cannot be created (" + error.message() + ")");
  }
}

bool HasEnded(TaskState state) {
  return state == TaskState::kComplete || state == TaskState::kFailed ||
         state == TaskState::kUnevaluated || state == TaskState::kRecorded;
}

/// Ground truth and flags of an evaluation.
std::string EvaluationText(const Task& task) {
  return task.ground_truth + "; " + SettingsText(task.evaluate);
}

/// Whether a run directory has an evaluation that can be read.
bool HasEvaluation(const std::string& run) try {
  ReadFigures(run, /*evaluated=*/true);
  return true;
} catch (const InputError&) {
  return false;
}

void Fail(TaskState state, int exit_code, std::vector<std::string> last_lines,
          TaskRecord* record) {
  record->state = state;
  record->exit_code = exit_code;
  record->last_lines = std::move(last_lines);
}

}  // namespace

std::string DamageOf(const std::string& run) try {
  ReadFigures(run, /*evaluated=*/false);
  const RunState state = ReadRunState(run);
  return state.marker ? FindMissing(*state.marker, run) : state.damage;
} catch (const InputError& error) {
  return error.what();
}

TaskRunner::TaskRunner(ExperimentFolder folder, const RunCommand& command,
                       TaskRunnerOptions options, RowFile rows,
                       StopRequest stop)
    : folder_(std::move(folder)),
      command_(command),
      options_(std::move(options)),
      rows_(std::move(rows)),
      stop_(std::move(stop)) {}

TaskResult TaskRunner::Run(const Task& task, int known_attempts) const {
  const std::string folder = folder_.TaskFolder(task.name);
  MakeFolder(folder);
  TaskResult result;
  const auto lock = DirectoryLock::TryAcquire(folder_.Lock(task.name));
  TaskRecord record = ReadTaskRecord(folder).value_or(TaskRecord());
  record.task = task;
  if (!lock) {
    result.passed_over = true;
    result.record = record;
    return result;
  }
  const bool done_meanwhile =
      record.attempts > known_attempts && HasEnded(record.state);
  const bool keeps_failure =
      options_.keep_failed && record.state == TaskState::kFailed;
  if (done_meanwhile || keeps_failure) {
    result.kept = record.state != TaskState::kFailed;
    result.record = record;
    return result;
  }
  if (TakeRecorded(&record)) {
    result.kept = true;
  } else if (Reconstruct(&record, &result) && Evaluate(&record)) {
    record.state = TaskState::kComplete;
    record.exit_code = 0;
    record.last_lines.clear();
  }
  result.stopped = record.state == TaskState::kStarted;
  record.ended = TimeText();
  WriteTaskRecord(folder, record);
  result.record = record;
  return result;
}

bool TaskRunner::TakeRecorded(TaskRecord* record) const try {
  const Task& task = record->task;
  const bool has_run = ReadRunState(folder_.Run(task.name)).Exists();
  const bool was_recorded = record->state == TaskState::kRecorded;
  if (options_.overwrite || has_run || (rows_.empty() && !was_recorded)) {
    return false;
  }
  const std::string identity = command_.Ask(task).Hash();
  if (was_recorded && record->identity == identity) return true;
  const RowFile::Row* row = rows_.Find(identity, task.sequence);
  if (row == nullptr) return false;
  record->identity = identity;
  record->figures = row->figures;
  record->wall_seconds = row->seconds;
  record->state = TaskState::kRecorded;
  record->last_lines.clear();
  record->exit_code = 0;
  return true;
} catch (const InputError&) {
  return false;  // Running it tells why.
}

bool TaskRunner::Reconstruct(TaskRecord* record, TaskResult* result) const {
  const Task& task = record->task;
  const std::string folder = folder_.TaskFolder(task.name);
  const std::string run = folder_.Run(task.name);
  const RunState before = ReadRunState(run);
  const bool was_complete = before.IsComplete() &&
                            before.Id() == record->run_id &&
                            (record->state == TaskState::kComplete ||
                             record->state == TaskState::kUnevaluated ||
                             record->state == TaskState::kChecking);
  const std::string damage = before.IsComplete() ? DamageOf(run) : "";
  record->state = was_complete ? TaskState::kChecking : TaskState::kStarted;
  ++record->attempts;
  record->host = HostName();
  record->started = TimeText();
  record->ended.clear();
  WriteTaskRecord(folder, *record);
  ChildResult child;
  try {
    const bool keep = !options_.overwrite && damage.empty();
    child =
        RunChild(command_.Run(task, run, keep),
                 (fs::path(folder) / "run").string(), stop_, options_.limits);
  } catch (const InputError& error) {
    child.exit_code = 2;
    child.last_lines = {error.what()};
  }
  if (!Accept(child, record)) return false;
  const RunState after = ReadRunState(run);
  result->kept = before.IsComplete() && before.Id() == after.Id();
  if (!result->kept) {
    record->wall_seconds = child.wall_seconds;
    record->cpu_seconds =
        !after.marker->resumed_at.empty() ? 0 : child.cpu_seconds;
    record->peak_memory_bytes = child.peak_memory_bytes;
    record->reason.clear();
    if (before.IsComplete()) {
      record->reason = damage.empty() ? Differences(before.marker->identity,
                                                    after.marker->identity)
                                      : damage;
      if (record->reason.empty()) record->reason = "--overwrite";
    }
  }
  record->run_id = after.Id();
  record->identity = after.marker->identity.Hash();
  return true;
}

bool TaskRunner::Accept(const ChildResult& child, TaskRecord* record) const {
  const RunState state = ReadRunState(folder_.Run(record->task.name));
  if (child.exit_code == 0 && state.IsComplete()) return true;
  const bool asked = stop_ && stop_() != Stop::kNo;
  std::vector<std::string> lines = child.last_lines;
  if (child.exit_code == 0) {
    lines.push_back("run.json: expected a complete run");
  }
  Fail(asked ? TaskState::kStarted : TaskState::kFailed,
       child.exit_code == 0 ? 1 : child.exit_code, lines, record);
  return false;
}

bool TaskRunner::Evaluate(TaskRecord* record) const {
  const Task& task = record->task;
  if (task.ground_truth.empty()) return true;
  const std::string run = folder_.Run(task.name);
  const std::string by = EvaluationText(task);
  const bool current = !options_.overwrite && record->evaluated_by == by &&
                       record->evaluated_id == record->run_id &&
                       HasEvaluation(run);
  if (current) return true;
  std::vector<std::string> arguments = {options_.evaluate_program,
                                        "--run=" + run,
                                        "--ground_truth=" + task.ground_truth};
  for (const auto& [key, value] : task.evaluate.entries()) {
    arguments.push_back("--" + key + "=" + value);
  }
  // What an earlier run was worth must not stand for this one's.
  record->evaluated_id.clear();
  const ChildResult child =
      RunChild(arguments,
               (fs::path(folder_.TaskFolder(task.name)) / "evaluate").string(),
               stop_, options_.limits);
  if (child.exit_code == 0 && HasEvaluation(run)) {
    record->evaluated_by = by;
    record->evaluated_id = record->run_id;
    return true;
  }
  const bool asked = stop_ && stop_() != Stop::kNo;
  std::vector<std::string> lines = child.last_lines;
  if (child.exit_code == 0) {
    lines.push_back("evaluation.json: expected an object 'headline'");
  }
  Fail(asked ? TaskState::kStarted : TaskState::kUnevaluated,
       child.exit_code == 0 ? 1 : child.exit_code, lines, record);
  return false;
}

std::string WhatIsToDo(const ExperimentFolder& folder,
                       const RunCommand& command, const Task& task) {
  const auto record = ReadTaskRecord(folder.TaskFolder(task.name));
  if (LivingHolder(folder.Lock(task.name))) return "running";
  const RunState state = ReadRunState(folder.Run(task.name));
  if (record && record->state == TaskState::kRecorded) return "recorded";
  if (!state.Exists() && !record) return "new";
  if (record && record->state == TaskState::kFailed) {
    return "failed: " + record->Error();
  }
  if (!state.IsComplete()) return "unfinished";
  const std::string damage = DamageOf(folder.Run(task.name));
  if (!damage.empty()) return "damaged: " + damage;
  try {
    const std::string why =
        Differences(state.marker->identity, command.Ask(task));
    return why.empty() ? "finished" : "changed: " + why;
  } catch (const InputError& error) {
    return std::string("fails: ") + error.what();
  }
}

}  // namespace splitfusion
