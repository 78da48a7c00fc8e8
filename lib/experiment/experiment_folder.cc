#include "splitfusion/lib/experiment/experiment_folder.h"

#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/experiment/design.h"
#include "splitfusion/lib/experiment/task_record.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Names of the entries of a folder, sorted; none if it is missing.
std::vector<std::string> Entries(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Experiments as they were run; files that are damaged are left out, since
/// their tasks have records of their own. Folders of sequences may be gone.
std::vector<Experiment> SavedExperiments(const ExperimentFolder& folder) {
  std::vector<Experiment> experiments;
  for (const std::string& name : Entries(folder.Experiments())) {
    const fs::path path = fs::path(folder.Experiments()) / name;
    if (path.extension() != ".json") continue;
    try {
      const Experiment saved = SavedExperiment(ReadJsonOrNull(path.string()));
      PlanTasks(saved);  // Throws where it is damaged.
      experiments.push_back(saved);
    } catch (const InputError&) {
      continue;
    }
  }
  return experiments;
}

/// Tasks that have a record and that no experiment plans.
std::vector<Task> RecordedTasks(const ExperimentFolder& folder,
                                const std::set<std::string>& planned) {
  std::vector<Task> tasks;
  for (const std::string& name : Entries(folder.Tasks())) {
    if (planned.count(name) > 0) continue;
    std::optional<TaskRecord> record = ReadTaskRecord(folder.TaskFolder(name));
    if (record) tasks.push_back(std::move(record->task));
  }
  return tasks;
}

/// The tables must not replace files of another program.
void CheckNoOthers(const ExperimentFolder& folder) {
  if (IsExperiment(folder)) return;
  for (const char* name :
       {"results.csv", "results.sqlite", "summary.csv", "differences.csv",
        "progress.log", "tasks", "associations.txt", "depth.txt"}) {
    if (!fs::exists(folder.Below(name))) continue;
    throw InputError(folder.root() + ": holds a " + name +
                     " of something else: expected the --output of an "
                     "experiment, or a new folder");
  }
}

void CheckSequence(const SequenceEntry& before, const SequenceEntry& now) {
  std::error_code ignored;
  const bool other = before.name == now.name && before.folder != now.folder &&
                     fs::is_directory(before.folder, ignored) &&
                     !fs::equivalent(before.folder, now.folder, ignored);
  if (!other) return;
  throw InputError("sequences: " + now.folder + " is named '" + now.name +
                   "' as is " + before.folder +
                   ", whose runs lie here: expected another name (in an "
                   "experiment file) or another --output");
}

}  // namespace

void AddExperiment(const ExperimentFolder& folder,
                   const Experiment& experiment) {
  CheckNoOthers(folder);
  for (const Experiment& saved : SavedExperiments(folder)) {
    for (const SequenceEntry& before : saved.sequences) {
      for (const SequenceEntry& now : experiment.sequences) {
        CheckSequence(before, now);
      }
    }
  }
  const nlohmann::ordered_json json = ToJson(experiment);
  const std::string hash =
      cv::format("_%016lx.json", StableHash(JsonText(json, 2)));
  const std::vector<std::string> names = Entries(folder.Experiments());
  for (const std::string& name : names) {
    if (name.find(hash) != std::string::npos) return;
  }
  const std::string number = cv::format("%04zu", names.size() + 1);
  WriteJson((fs::path(folder.Experiments()) / (number + hash)).string(),
            Versioned(json), 2);
}

bool IsExperiment(const ExperimentFolder& folder) {
  return !SavedExperiments(folder).empty() ||
         !RecordedTasks(folder, {}).empty();
}

std::vector<Task> KnownTasks(const ExperimentFolder& folder) {
  std::vector<Task> tasks;
  std::set<std::string> names;
  for (const Experiment& experiment : SavedExperiments(folder)) {
    for (Task& task : PlanTasks(experiment)) {
      if (names.insert(task.name).second) tasks.push_back(std::move(task));
    }
  }
  for (Task& task : RecordedTasks(folder, names)) {
    tasks.push_back(std::move(task));
  }
  if (!tasks.empty()) return tasks;
  throw InputError(folder.root() +
                   ": holds no experiment; expected the --output of sf_batch "
                   "run");
}

std::string KnownBaseline(const ExperimentFolder& folder) {
  std::string baseline;
  for (const Experiment& experiment : SavedExperiments(folder)) {
    if (!experiment.baseline.empty()) baseline = experiment.baseline;
  }
  return baseline;
}

}  // namespace splitfusion
