#include "splitfusion/lib/experiment/task_evaluation.h"

#include <set>

#include "splitfusion/lib/base/content_cache.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/experiment/child_process.h"
#include "splitfusion/lib/experiment/scratch_folder.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

/// Of names and contents; where the files lie does not count.
std::string GroundTruthHash(const std::string& folder) try {
  const ContentCache cache(UserCacheFolder());
  return cache.HashOfFiles(GroundTruthRoot(folder), GroundTruthFiles(folder));
} catch (const InputError& error) {
  return error.what();  // sf_evaluate fails on it, and says so.
}

}  // namespace

NamedValues EvaluationParts(const Task& task) {
  if (task.ground_truth.empty()) return {};
  NamedValues parts = {{"ground_truth", GroundTruthHash(task.ground_truth)}};
  for (const auto& [key, value] : task.evaluate.entries()) {
    parts["evaluate." + key] = value;
  }
  return parts;
}

bool GroundTruthIsGone(const Task& task) {
  return !task.ground_truth.empty() &&
         GroundTruthFiles(task.ground_truth).empty();
}

std::vector<std::string> EvaluateCommand(const std::string& program,
                                         const Task& task,
                                         const std::string& run) {
  std::vector<std::string> arguments = {program, "--run=" + run,
                                        "--ground_truth=" + task.ground_truth};
  for (const auto& [key, value] : task.evaluate.entries()) {
    arguments.push_back("--" + key + "=" + value);
  }
  return arguments;
}

std::string ForeignEvaluation(const TaskRecord& record,
                              const std::string& run) {
  const bool same = record.evaluation.empty() ||
                    record.evaluation == HashOfFile(RunPaths(run).Evaluation());
  return same ? "" : "evaluated by hand";
}

void CheckEvaluateFlags(const std::string& program,
                        const std::vector<Task>& tasks) {
  std::set<std::string> checked;
  const ScratchFolder folder;
  for (const Task& task : tasks) {
    if (task.ground_truth.empty()) continue;
    if (!checked.insert(SettingsText(task.evaluate)).second) continue;
    std::vector<std::string> command =
        EvaluateCommand(program, task, folder.path());
    command.emplace_back("--check_only");
    const ChildResult child = RunChild(command, folder.path() + "/check");
    if (child.exit_code == 0) continue;
    throw InputError("evaluate \"" + SettingsText(task.evaluate) +
                     "\": " + child.LastLine());
  }
}

}  // namespace splitfusion
