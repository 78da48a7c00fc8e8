#include "splitfusion/lib/experiment/result_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/outdated_runs.h"
#include "splitfusion/lib/experiment/run_state.h"
#include "splitfusion/lib/experiment/task_evaluation.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRowKey = "row";

/// Whether a run was left in the middle of being done again.
bool IsLeft(const std::string& run) {
  std::error_code ignored;
  return fs::is_directory(fs::path(run) / "unfinished", ignored);
}

/// Status of a task with a record and a run directory.
std::string RecordedStatus(const TaskRecord& record, const RunState& state,
                           const std::string& run) {
  switch (record.state) {
    case TaskState::kFailed:
    case TaskState::kUnevaluated:
      return ToString(record.state);
    case TaskState::kRecorded:
      return "complete";
    case TaskState::kWaiting:
      return "waiting";
    case TaskState::kStarted:
      return "unfinished";
    case TaskState::kChecking:
    case TaskState::kComplete:
      break;
  }
  if (!state.Exists()) return "damaged: run.json: missing";
  if (!state.marker) return "damaged: " + state.damage;
  const bool same = state.IsComplete() && state.Id() == record.run_id;
  const bool left = record.state == TaskState::kChecking && IsLeft(run);
  return same && !left ? "complete" : "unfinished";
}

/// Status of a task by its run directory alone.
std::string BareStatus(const RunState& state, const std::string& folder) {
  std::error_code ignored;
  if (!state.Exists()) {
    return fs::exists(fs::path(folder) / "task.json", ignored)
               ? "damaged: task.json: expected what sf_batch writes"
               : "waiting";
  }
  if (!state.marker) return "damaged: " + state.damage;
  const RunStatus status = state.marker->status;
  return status == RunStatus::kRunning ? "unfinished" : ToString(status);
}

/// What sf_run does not say itself.
void FillCost(const RunCost& cost, Figures* figures) {
  double& cpu = figures->At("cpu_seconds_per_frame");
  if (!std::isfinite(cpu)) cpu = cost.cpu_seconds / figures->At("frames");
  double& memory = figures->At("peak_memory_bytes");
  if (!std::isfinite(memory)) memory = cost.peak_memory_bytes;
}

void FillFigures(const std::string& run, const RunState& state,
                 const TaskRecord& record, ResultRow* row) {
  if (record.state == TaskState::kRecorded) {
    row->figures = record.figures;
    return;
  }
  try {
    row->figures = ReadFigures(run, !row->task.ground_truth.empty());
  } catch (const InputError& error) {
    row->status = std::string("damaged: ") + error.what();
    return;
  }
  if (state.marker && !state.marker->resumed_at.empty()) {
    // Of its last part alone.
    row->figures.At("peak_memory_bytes") =
        std::numeric_limits<double>::quiet_NaN();
  }
  FillCost(record.cost, &row->figures);
  if (row->task.ground_truth.empty()) return;
  MarkOutdated(ForeignEvaluation(record, run), row);
}

/// What the run directory and the record say of a row besides its status.
void FillFacts(const RunState& state, const TaskRecord* record,
               ResultRow* row) {
  if (state.marker) {
    row->error = state.marker->error;
    row->identity = state.marker->identity.Hash();
    row->parts = state.marker->identity.parts;
  }
  if (record == nullptr) return;
  row->error = record->Error();
  row->identity = record->identity;
  if (record->state == TaskState::kRecorded)
    row->parts = record->identity_parts;
  row->evaluated_by = record->evaluated_by;
  row->ended = record->ended;
  row->cost = record->cost;
}

ResultRow ReadRow(const ExperimentFolder& folder, const Task& task) {
  const std::string run = folder.Run(task.name);
  const auto record = ReadTaskRecord(folder.TaskFolder(task.name));
  const RunState state = ReadRunState(run);
  ResultRow row;
  row.task = record ? record->task : task;
  FillFacts(state, record ? &*record : nullptr, &row);
  if (LivingHolder(folder.Lock(task.name))) {
    row.status = "running";
  } else {
    row.status = record ? RecordedStatus(*record, state, run)
                        : BareStatus(state, folder.TaskFolder(task.name));
  }
  if (row.IsComplete()) {
    FillFigures(run, state, record.value_or(TaskRecord()), &row);
  }
  return row;
}

void AddKeys(const std::vector<std::string>& more,
             std::vector<std::string>* keys) {
  for (const std::string& key : more) {
    if (std::find(keys->begin(), keys->end(), key) == keys->end()) {
      keys->push_back(key);
    }
  }
}

/// Keys in which tasks of one sequence differ, in the order of their settings.
std::vector<std::string> DifferingKeys(const std::vector<ResultRow>& rows) {
  std::vector<std::string> keys;
  for (const ResultRow& row : rows) {
    std::vector<std::string> own;
    for (const auto& entry : row.task.settings.entries()) {
      own.push_back(entry.first);
    }
    AddKeys(own, &keys);
  }
  std::vector<std::string> differing;
  for (const std::string& key : keys) {
    std::map<std::string, std::set<std::string>> values;
    bool differs = false;
    for (const ResultRow& row : rows) {
      const std::string* value = row.task.settings.Find(key);
      auto& known = values[row.task.sequence];
      known.insert(value ? "=" + *value : "");
      differs = differs || known.size() > 1;
    }
    if (differs) differing.push_back(key);
  }
  return differing;
}

void FillValues(ResultTable* table) {
  const auto& rows = table->rows;
  const bool has_rows =
      std::any_of(rows.begin(), rows.end(),
                  [](const ResultRow& row) { return !row.task.row.empty(); });
  if (has_rows) table->keys.push_back(kRowKey);
  for (const ResultRow& row : rows) AddKeys(row.task.design, &table->keys);
  for (const ResultRow& row : rows) AddKeys(row.task.grouped, &table->keys);
  AddKeys(DifferingKeys(rows), &table->keys);
  for (ResultRow& row : table->rows) {
    for (const std::string& key : table->keys) {
      row.values.push_back(ValueOf(row.task, key));
    }
  }
}

}  // namespace

std::string ValueOf(const Task& task, const std::string& key) {
  if (key == kRowKey) return task.row;
  const std::string* value = task.settings.Find(key);
  return value ? *value : "";
}

ResultTable CollectResults(const ExperimentFolder& folder) {
  ResultTable table;
  for (const Task& task : KnownTasks(folder)) {
    table.rows.push_back(ReadRow(folder, task));
  }
  FillValues(&table);
  MarkOutdated(&table);
  return table;
}

ResultTable PlannedTable(const std::vector<Task>& tasks) {
  ResultTable table;
  for (const Task& task : tasks) {
    ResultRow row;
    row.task = task;
    row.status = "waiting";
    table.rows.push_back(row);
  }
  FillValues(&table);
  return table;
}

void AddToRowFile(const ResultTable& table, const std::string& path) {
  RowFile file(path);
  for (const ResultRow& row : table.rows) {
    if (!row.IsComplete() || row.identity.empty()) continue;
    file.Set(
        RowKey(row.identity, row.evaluated_by),
        {row.task.name, row.task.sequence, row.task.row,
         SettingsText(row.task.settings), row.cost.wall_seconds, row.figures});
  }
  file.Write(path);
}

}  // namespace splitfusion
