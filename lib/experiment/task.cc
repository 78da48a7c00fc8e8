#include "splitfusion/lib/experiment/task.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/design.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> Keys(const Settings& settings) {
  std::vector<std::string> keys;
  for (const auto& entry : settings.entries()) keys.push_back(entry.first);
  return keys;
}

/// Letters, digits, hyphens and dots stay, for the name of a folder.
std::string Readable(const std::string& name) {
  std::string text = name.substr(0, 60);
  for (char& c : text) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                      c == '-' || c == '.' || c == '_';
    if (!kept) c = '_';
  }
  return text.empty() || text[0] == '.' ? "_" + text : text;
}

std::string TaskName(const Task& task) {
  std::vector<Settings::Entry> entries = task.settings.entries();
  std::sort(entries.begin(), entries.end());
  std::string text = task.sequence + '\n' + task.row;
  for (const auto& [key, value] : entries) text += '\n' + key + '=' + value;
  return Readable(task.sequence) +
         cv::format("_%010lx_r%d", StableHash(text) >> 24, task.repeat);
}

/// The tasks of one sequence, row and point.
std::vector<Task> PlanRepeats(const Experiment& experiment,
                              const SequenceEntry& sequence,
                              const NamedSettings& row, const Settings& point) {
  Task task;
  task.sequence = sequence.name;
  task.sequence_folder = sequence.folder;
  task.ground_truth = sequence.ground_truth;
  task.row = row.name;
  task.settings = experiment.set;
  for (const Settings& more : {sequence.set, row.set, point}) {
    task.settings.SetAll(more);
  }
  task.design = Keys(point);
  task.grouped = Keys(row.set);
  task.evaluate = experiment.evaluate;
  std::vector<Task> tasks;
  for (int i = 0; i < experiment.repeat; ++i) {
    task.repeat = i;
    task.name = TaskName(task);
    tasks.push_back(task);
  }
  return tasks;
}

}  // namespace

std::vector<Task> PlanTasks(const Experiment& experiment) {
  experiment.Check();
  const std::vector<Settings> points =
      experiment.random > 0
          ? DrawDesign(experiment.grid, experiment.random, experiment.seed)
          : ExpandGrid(experiment.grid);
  std::vector<NamedSettings> rows = experiment.rows;
  if (rows.empty()) rows.emplace_back();
  std::vector<Task> tasks;
  std::set<std::string> names;
  for (const SequenceEntry& sequence : experiment.sequences) {
    for (const NamedSettings& row : rows) {
      for (const Settings& point : points) {
        for (Task& task : PlanRepeats(experiment, sequence, row, point)) {
          if (names.insert(task.name).second) tasks.push_back(std::move(task));
        }
      }
    }
  }
  return tasks;
}

Task MakeForeignTask(const Task& task, const std::string& system) {
  Task foreign;
  foreign.sequence = task.sequence;
  foreign.sequence_folder = task.sequence_folder;
  foreign.ground_truth = task.ground_truth;
  foreign.row = system;
  foreign.name = TaskName(foreign);
  return foreign;
}

Json ToJson(const Task& task) {
  return {{"task", task.name},
          {"sequence", task.sequence},
          {"sequence_folder", task.sequence_folder},
          {"ground_truth", task.ground_truth},
          {"row", task.row},
          {"repeat", task.repeat},
          {"settings", ToJson(task.settings)},
          {"design", task.design},
          {"grouped", task.grouped},
          {"evaluate", ToJson(task.evaluate)}};
}

Task TaskFromJson(const Json& json) try {
  Task task;
  task.name = json.at("task").get<std::string>();
  task.sequence = json.at("sequence").get<std::string>();
  task.sequence_folder = json.at("sequence_folder").get<std::string>();
  task.ground_truth = json.at("ground_truth").get<std::string>();
  task.row = json.at("row").get<std::string>();
  task.repeat = json.at("repeat").get<int>();
  task.settings = SettingsFromJson(json.at("settings"), "settings");
  task.design = json.at("design").get<std::vector<std::string>>();
  task.grouped = json.at("grouped").get<std::vector<std::string>>();
  task.evaluate = SettingsFromJson(json.at("evaluate"), "evaluate");
  return task;
} catch (const nlohmann::json::exception& error) {
  throw InputError(std::string("task: expected what sf_batch writes (") +
                   error.what() + ")");
}

}  // namespace splitfusion
