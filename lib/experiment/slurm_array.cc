#include "splitfusion/lib/experiment/slurm_array.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// One word of a line for sh, whatever is in it.
std::string ShellWord(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

/// Slurm replaces %-patterns in names of files.
std::string WithoutPatterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

std::string Absolute(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

/// What an element is, for sbatch.
std::string Directives(const SlurmArray& array) {
  std::vector<std::string> options = {
      "job-name=sf_batch", "requeue",
      "open-mode=append",  "nodes=1",
      "ntasks=1",          "cpus-per-task=" + std::to_string(array.cpus)};
  if (array.mebibytes > 0) {
    options.push_back("mem=" + std::to_string(array.mebibytes) + "M");
  }
  if (array.minutes > 0) {
    options.push_back("time=" + std::to_string(array.minutes));
  }
  std::string text;
  for (const std::string& option : options) {
    text += "#SBATCH --" + option + '\n';
  }
  return text;
}

/// What an element does. sf_batch takes the place of the shell, so that it gets
/// the signals of Slurm.
std::string ElementScript(const SlurmArray& array) {
  std::string text = "#!/bin/sh\n" + Directives(array) + "exec";
  for (const std::string& word : array.command) text += " " + ShellWord(word);
  return text + " --task=$(($1 + SLURM_ARRAY_TASK_ID))\n";
}

/// Threads of a run.
int ThreadsOf(const Task& task, int otherwise) {
  const std::string* own = task.settings.Find("threads");
  return std::max(1, own ? std::atoi(own->c_str()) : otherwise);
}

/// sf_batch and what it needs to run a task as the options say.
std::vector<std::string> TaskCommand(const SweepOptions& options,
                                     const std::string& program,
                                     const std::string& list) {
  constexpr double kMinute = 60, kGigabyte = 1e9;
  const ChildLimits& limits = options.runner.limits;
  std::vector<std::string> command = {
      Absolute(program),
      "run",
      "--output=" + Absolute(options.output),
      "--run_program=" + Absolute(options.run_program),
      "--evaluate_program=" + Absolute(options.runner.evaluate_program),
      "--threads=" + std::to_string(std::max(1, options.threads))};
  const auto add_limit = [&](const char* name, double value) {
    if (value > 0) command.push_back(cv::format("--%s=%.9g", name, value));
  };
  add_limit("max_wall_minutes", limits.wall_seconds / kMinute);
  add_limit("max_cpu_minutes", limits.cpu_seconds / kMinute);
  add_limit("max_memory_gb",
            static_cast<double>(limits.memory_bytes) / kGigabyte);
  if (options.runner.keep_failed) command.emplace_back("--keep_failed");
  command.push_back("--task_list=" + Absolute(list));
  return command;
}

}  // namespace

void SlurmArray::Check() const {
  CheckOption(max_array >= 1, "slurm_max_array", max_array,
              "MaxArraySize of scontrol show config, at least 1");
}

std::vector<Task> UnfinishedTasks(const std::vector<PlannedTask>& tasks,
                                  bool keep_failed) {
  std::vector<Task> unfinished;
  for (const auto& [task, what] : tasks) {
    const bool is_done = what == "finished" || what == "recorded" ||
                         (keep_failed && what.rfind("failed:", 0) == 0);
    if (!is_done) unfinished.push_back(task);
  }
  return unfinished;
}

SlurmArray MakeSlurmArray(const std::vector<Task>& tasks,
                          const SweepOptions& options,
                          const std::string& program, const std::string& list) {
  constexpr double kMebibyte = 1048576, kMinute = 60;
  constexpr int kOwnMebibytes = 512, kOwnMinutes = 10;
  const ChildLimits& limits = options.runner.limits;
  SlurmArray array;
  array.command = TaskCommand(options, program, list);
  array.log_folder = fs::path(Absolute(list)).parent_path().string();
  array.tasks = static_cast<int>(tasks.size());
  for (const Task& task : tasks) {
    array.cpus = std::max(array.cpus, ThreadsOf(task, options.threads));
  }
  if (limits.memory_bytes > 0) {
    array.mebibytes =
        std::llround(
            std::ceil(static_cast<double>(limits.memory_bytes) / kMebibyte)) +
        kOwnMebibytes;
  }
  if (limits.wall_seconds > 0) {
    array.minutes =
        std::llround(std::ceil(limits.wall_seconds / kMinute)) + kOwnMinutes;
  }
  return array;
}

std::string SlurmScript(const SlurmArray& array) {
  array.Check();
  const int arrays = (array.tasks + array.max_array - 1) / array.max_array;
  std::string text =
      "#!/bin/sh\n"
      "# Runs " +
      std::to_string(array.tasks) + " tasks in " + std::to_string(arrays) +
      " arrays of Slurm. Arguments are further options of sbatch.\n"
      "set -eu\n"
      "submit() {  # NUMBER of the first task, TASKS, options of sbatch\n"
      "first=\"$1\" last=\"$(($2 - 1))\"\n"
      "shift 2\n"
      "sbatch --array=\"0-$last\" --output=" +
      ShellWord(WithoutPatterns(array.log_folder) + "/%A_%a.log") +
      " \\\n"
      "  \"$@\" /dev/stdin \"$first\" <<'END_OF_ELEMENT'\n" +
      ElementScript(array) + "END_OF_ELEMENT\n}\n";
  for (int begin = 0; begin < array.tasks; begin += array.max_array) {
    const int count = std::min(array.max_array, array.tasks - begin);
    text += "submit " + std::to_string(begin + 1) + " " +
            std::to_string(count) + " \"$@\"\n";
  }
  return text;
}

}  // namespace splitfusion
