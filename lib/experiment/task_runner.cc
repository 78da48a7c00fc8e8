#include "splitfusion/lib/experiment/task_runner.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/base/random_id.h"
#include "splitfusion/lib/experiment/run_state.h"
#include "splitfusion/lib/experiment/task_evaluation.h"
#include "splitfusion/lib/report/run_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

bool HasEnded(TaskState state) {
  return state == TaskState::kComplete || state == TaskState::kFailed ||
         state == TaskState::kUnevaluated || state == TaskState::kRecorded;
}

/// Why a finished run cannot be kept, whatever sf_run says; empty if it can.
std::string DamageOf(const std::string& run) try {
  ReadFigures(run, /*evaluated=*/false);
  return "";
} catch (const InputError& error) {
  return error.what();
}

/// Why the evaluation of a finished run has to be done again; empty if it
/// stands.
std::string StaleEvaluation(const TaskRecord& record, const std::string& run_id,
                            const NamedValues& parts, const std::string& run) {
  if (record.evaluated_id != run_id) return "was not finished";
  const std::string changes = Differences(record.evaluated_by, parts);
  if (!changes.empty()) return changes;
  try {
    ReadFigures(run, /*evaluated=*/true);
    return ForeignEvaluation(record, run);
  } catch (const InputError& error) {
    return error.what();
  }
}

/// When a computer has died, the lock of its run may fall silent some seconds
/// after that of its task: waits so long for the lock of a run elsewhere.
void AwaitSilence(const std::string& lock, const StopRequest& stop) {
  constexpr int kLooks = 100;
  constexpr std::chrono::milliseconds kBetween(200);
  for (int i = 0; i < kLooks; ++i) {
    const std::optional<LockHolder> holder = LivingHolder(lock);
    const bool stopped = stop && stop() != Stop::kNo;
    if (!holder || holder->host == HostName() || stopped) return;
    std::this_thread::sleep_for(kBetween);
  }
}

/// Sets aside a run directory that sf_run could not use: in the folder of an
/// experiment it is the batch's own. What was wrong with it; empty if nothing.
///
/// @throw InputError if it cannot be renamed.
std::string SetAside(const std::string& run) {
  if (LivingHolder(RunPaths(run).Lock())) return "";
  const std::string damage = RunFolderDamage(run);
  if (damage.empty()) return "";
  const std::string aside = run + ".before-" + RandomId().substr(0, 8);
  std::error_code error;
  fs::rename(run, aside, error);
  if (error) {
    throw InputError(aside + ": cannot be written (" + error.message() + ")");
  }
  return damage + "; it is now " + fs::path(aside).filename().string();
}

/// What is known of what a run has used, where its last part has ended.
RunCost CostOf(const ChildResult& child, const RunMarker& marker) {
  if (!marker.resumed_at.empty()) return {};
  return {child.wall_seconds, child.cpu_seconds,
          static_cast<double>(child.peak_memory_bytes)};
}

/// Why a run was not kept, which it was before.
std::string ReasonOf(const RunState& before, const RunState& after,
                     const std::string& damage) {
  if (!before.IsComplete()) return "";
  if (!damage.empty()) return damage;
  const std::string changes =
      Differences(before.marker->identity, after.marker->identity);
  return changes.empty() ? "--overwrite" : changes;
}

void Fail(TaskState state, int exit_code, std::vector<std::string> last_lines,
          TaskRecord* record) {
  record->state = state;
  record->exit_code = exit_code;
  record->last_lines = std::move(last_lines);
}

/// Whether a task was recorded with what decides its figures now.
bool IsOfNow(const TaskRecord& record, const RunIdentity& identity,
             const NamedValues& evaluation) {
  return record.identity == identity.Hash() &&
         record.evaluated_by == evaluation;
}

/// Whether what was recorded of a task is what it would be now. A row of others
/// has no identity, and always is.
bool IsStillRecorded(const TaskRecord& record, const RunCommand& command) try {
  return record.identity.empty() || IsOfNow(record, command.Ask(record.task),
                                            EvaluationParts(record.task));
} catch (const InputError&) {
  return false;  // Running it tells why.
}

}  // namespace

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
  TaskRecord& record = result.record;
  const auto lock = DirectoryLock::TryAcquire(folder_.Lock(task.name));
  record = ReadTaskRecord(folder).value_or(TaskRecord());
  const Task before = record.task;
  record.task = task;
  if (!lock) {
    result.passed_over = true;
    return result;
  }
  if (task.ground_truth.empty() && !record.evaluated_by.empty()) {
    // A truth that is gone is missed, not forgotten.
    record.task.ground_truth = before.ground_truth;
    record.task.evaluate = before.evaluate;
  }
  const bool done_meanwhile =
      record.attempts > known_attempts && HasEnded(record.state);
  const bool keeps_failure =
      options_.keep_failed && record.state == TaskState::kFailed;
  if (done_meanwhile || keeps_failure) {
    result.kept = record.state != TaskState::kFailed;
    return result;
  }
  if (TakeRecorded(&record)) {
    result.kept = true;
  } else if (Reconstruct(&result) && Evaluate(&result)) {
    record.state = TaskState::kComplete;
    record.exit_code = 0;
    record.last_lines.clear();
  }
  result.stopped = record.state == TaskState::kStarted;
  record.ended = TimeText();
  WriteTaskRecord(folder, record);
  return result;
}

bool TaskRunner::TakeRecorded(TaskRecord* record) const try {
  const Task& task = record->task;
  const bool has_run = ReadRunState(folder_.Run(task.name)).Exists();
  const bool was_recorded = record->state == TaskState::kRecorded;
  if (options_.overwrite || has_run || (rows_.empty() && !was_recorded)) {
    return false;
  }
  const RunIdentity identity = command_.Ask(task);
  const NamedValues evaluation = EvaluationParts(task);
  if (was_recorded && IsOfNow(*record, identity, evaluation)) return true;
  const RowFile::Row* row =
      rows_.Find(RowKey(identity.Hash(), evaluation), task.sequence);
  if (row == nullptr) return false;
  record->identity = identity.Hash();
  record->identity_parts = identity.parts;
  record->evaluated_by = evaluation;
  record->figures = row->figures;
  record->cost = RunCost();
  record->cost.wall_seconds = row->seconds;
  record->state = TaskState::kRecorded;
  record->last_lines.clear();
  record->exit_code = 0;
  return true;
} catch (const InputError&) {
  return false;  // Running it tells why.
}

ChildResult TaskRunner::CallRun(const Task& task, bool keep) const {
  const fs::path log = fs::path(folder_.TaskFolder(task.name)) / "run";
  try {
    return RunChild(command_.Run(task, folder_.Run(task.name), keep),
                    log.string(), stop_, options_.limits);
  } catch (const InputError& error) {
    ChildResult refused;
    refused.exit_code = 2;
    refused.last_lines = {error.what()};
    return refused;
  }
}

bool TaskRunner::Reconstruct(TaskResult* result) const {
  TaskRecord& record = result->record;
  const std::string run = folder_.Run(record.task.name);
  AwaitSilence(RunPaths(run).Lock(), stop_);
  const std::string set_aside = SetAside(run);
  const RunState before = ReadRunState(run);
  const bool was_complete = before.IsComplete() &&
                            before.Id() == record.run_id &&
                            (record.state == TaskState::kComplete ||
                             record.state == TaskState::kUnevaluated ||
                             record.state == TaskState::kChecking);
  const std::string damage = before.IsComplete() ? DamageOf(run) : "";
  record.state = was_complete ? TaskState::kChecking : TaskState::kStarted;
  ++record.attempts;
  record.host = HostName();
  record.started = TimeText();
  record.ended.clear();
  WriteTaskRecord(folder_.TaskFolder(record.task.name), record);
  const bool keep = !options_.overwrite && damage.empty();
  const ChildResult child = CallRun(record.task, keep);
  if (!Accept(child, &record)) return false;
  const RunState after = ReadRunState(run);
  result->kept = before.IsComplete() && before.Id() == after.Id();
  if (!result->kept) {
    record.cost = CostOf(child, *after.marker);
    record.reason =
        set_aside.empty() ? ReasonOf(before, after, damage) : set_aside;
  } else if (record.run_id != after.Id()) {
    record.cost = RunCost();  // It ended unwatched.
  }
  record.run_id = after.Id();
  record.identity = after.marker->identity.Hash();
  const std::string changes =
      command_.ChangesSincePlanned(record.task, after.marker->identity);
  if (changes.empty()) return true;
  Fail(TaskState::kFailed, 1,
       {"changed while the experiment went on: " + changes}, &record);
  return false;
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

ChildResult TaskRunner::CallEvaluate(const Task& task) const {
  const fs::path log = fs::path(folder_.TaskFolder(task.name)) / "evaluate";
  return RunChild(
      EvaluateCommand(options_.evaluate_program, task, folder_.Run(task.name)),
      log.string(), stop_, options_.limits);
}

bool TaskRunner::KeepEvaluation(TaskResult* result) const {
  TaskRecord& record = result->record;
  const std::string gone = "ground truth is gone: " + record.task.ground_truth;
  const std::string stale =
      StaleEvaluation(record, record.run_id, record.evaluated_by,
                      folder_.Run(record.task.name));
  if (stale.empty()) {
    result->evaluation = "and its evaluation, for " + gone;
    return true;
  }
  Fail(TaskState::kUnevaluated, 2, {gone}, &record);
  return false;
}

bool TaskRunner::Evaluate(TaskResult* result) const {
  TaskRecord& record = result->record;
  if (record.task.ground_truth.empty()) {
    record.evaluated_by.clear();
    return true;
  }
  const std::string run = folder_.Run(record.task.name);
  if (GroundTruthIsGone(record.task)) return KeepEvaluation(result);
  const NamedValues parts = EvaluationParts(record.task);
  std::string why = StaleEvaluation(record, record.run_id, parts, run);
  if (why.empty() && options_.overwrite) why = "--overwrite";
  if (why.empty()) return true;
  if (result->kept) result->evaluation = "evaluated again: " + why;
  // What an earlier run was worth must not stand for this one's.
  record.evaluated_id.clear();
  const ChildResult child = CallEvaluate(record.task);
  std::vector<std::string> lines = child.last_lines;
  if (child.exit_code == 0) {
    record.evaluated_by = parts;
    record.evaluated_id = record.run_id;
    record.evaluation.clear();
    const std::string damage =
        StaleEvaluation(record, record.run_id, parts, run);
    if (damage.empty()) {
      record.evaluation = HashOfFile(RunPaths(run).Evaluation());
      return true;
    }
    record.evaluated_id.clear();
    lines.push_back(damage);
  }
  const bool asked = stop_ && stop_() != Stop::kNo;
  Fail(asked ? TaskState::kStarted : TaskState::kUnevaluated,
       child.exit_code == 0 ? 1 : child.exit_code, lines, &record);
  return false;
}

std::string WhatIsToDo(const ExperimentFolder& folder,
                       const RunCommand& command, const Task& task) {
  const auto record = ReadTaskRecord(folder.TaskFolder(task.name));
  if (LivingHolder(folder.Lock(task.name))) return "running";
  const RunState state = ReadRunState(folder.Run(task.name));
  if (record && record->state == TaskState::kRecorded) {
    return IsStillRecorded(*record, command) ? "recorded"
                                             : "changed: since it was recorded";
  }
  if (!state.Exists() && !record) return "new";
  if (record && record->state == TaskState::kFailed) {
    return "failed: " + record->Error();
  }
  if (!state.IsComplete()) return "unfinished";
  const std::string damage = DamageOf(folder.Run(task.name));
  if (!damage.empty()) return "damaged: " + damage;
  try {
    std::string why = Differences(state.marker->identity, command.Ask(task));
    if (!why.empty()) return "changed: " + why;
    if (task.ground_truth.empty()) return "finished";
    why = StaleEvaluation(record.value_or(TaskRecord()), state.Id(),
                          EvaluationParts(task), folder.Run(task.name));
    return why.empty() ? "finished" : "to be evaluated: " + why;
  } catch (const InputError& error) {
    return std::string("fails: ") + error.what();
  }
}

}  // namespace splitfusion
