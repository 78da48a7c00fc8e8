#include "splitfusion/lib/experiment/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <thread>

#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/experiment/task_evaluation.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Between two looks at tasks that others work on.
constexpr std::chrono::milliseconds kPollInterval(200);

void CheckProgram(const std::string& path, const std::string& what) {
  if (!fs::is_regular_file(path)) {
    throw InputError(path + ": not found; expected the program " + what);
  }
}

void CheckPrograms(const std::vector<Task>& tasks,
                   const SweepOptions& options) {
  for (const Task& task : tasks) {
    const std::string* own = task.settings.Find(kRunProgramKey);
    CheckProgram(own ? *own : options.run_program, "sf_run");
    if (task.ground_truth.empty()) continue;
    CheckProgram(options.runner.evaluate_program, "sf_evaluate");
  }
}

/// All that can be refused is refused before the first run.
void CheckBeforeRuns(const std::vector<Task>& tasks,
                     const SweepOptions& options, RunCommand* command) {
  options.Check();
  CheckPrograms(tasks, options);
  CheckEvaluateFlags(options.runner.evaluate_program, tasks);
  command->CheckOptions(tasks);
}

void AppendLine(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::app)
      << TimeText() + " " + HostName() + " " + text + "\n"
      << std::flush;
}

bool IsFailure(const TaskResult& result) {
  return result.record.state == TaskState::kFailed ||
         result.record.state == TaskState::kUnevaluated;
}

/// Hands the tasks to threads.
class SweepQueue {
 public:
  SweepQueue(const std::vector<Task>& tasks, const SweepOptions& options,
             const RunCommand& command, SweepCallback progress,
             const StopRequest& stop)
      : options_(options),
        folder_(options.output),
        runner_(
            folder_, command, options.runner,
            options.row_file.empty() ? RowFile() : RowFile(options.row_file),
            stop),
        progress_(std::move(progress)),
        stop_(stop),
        left_(tasks.begin(), tasks.end()) {
    outcome_.planned = static_cast<int>(tasks.size());
    for (const Task& task : tasks) {
      const auto record = ReadTaskRecord(folder_.TaskFolder(task.name));
      attempts_[task.name] = record ? record->attempts : 0;
    }
  }

  SweepOutcome Run() {
    const int jobs = std::min(options_.jobs, std::max(1, outcome_.planned));
    std::vector<std::thread> threads;
    threads.reserve(static_cast<std::size_t>(jobs));
    for (int i = 0; i < jobs; ++i) {
      threads.emplace_back([this] { Work(); });
    }
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return outcome_;
  }

 private:
  void Work() {
    try {
      while (const std::optional<Task> task = Take()) {
        Give(runner_.Run(*task, attempts_.at(task->name)));
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = std::current_exception();
    }
  }

  /// The next task; those that others work on come again after all others.
  std::optional<Task> Take() {
    while (true) {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const bool stopped = stop_ && stop_() != Stop::kNo;
        const bool failed = options_.fail_fast && outcome_.failed > 0;
        if (failure_ || stopped || failed) return std::nullopt;
        const bool wait = left_.empty();
        if (wait && others_.empty()) return std::nullopt;
        if (!wait) return TakeFirst(&left_);
        for (std::size_t i = 0; i < others_.size(); ++i) {
          if (!LivingHolder(folder_.Lock(others_.front().name))) {
            return TakeFirst(&others_);
          }
          others_.push_back(others_.front());
          others_.pop_front();
        }
      }
      std::this_thread::sleep_for(kPollInterval);
    }
  }

  static Task TakeFirst(std::deque<Task>* tasks) {
    Task task = std::move(tasks->front());
    tasks->pop_front();
    return task;
  }

  void Give(const TaskResult& result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (result.passed_over) {
      others_.push_back(result.record.task);
      return;
    }
    if (result.stopped) return;
    if (!result.kept) ++executed_;
    ++outcome_.ended;
    outcome_.failed += IsFailure(result) ? 1 : 0;
    const SweepProgress progress = {outcome_.ended, outcome_.planned,
                                    SecondsLeft(), result};
    AppendLine(folder_.Progress(), progress.ToString());
    if (progress_) progress_(progress);
  }

  double SecondsLeft() const {
    const int left = outcome_.planned - outcome_.ended;
    return executed_ == 0 ? 0 : stopwatch_.Seconds() * left / executed_;
  }

  const SweepOptions& options_;
  const ExperimentFolder folder_;
  const TaskRunner runner_;
  const SweepCallback progress_;
  const StopRequest& stop_;
  const Stopwatch stopwatch_;
  std::map<std::string, int> attempts_;  ///< When this sweep began.
  std::mutex mutex_;                     // Guards everything below.
  std::deque<Task> left_;
  std::deque<Task> others_;  ///< That others work on.
  SweepOutcome outcome_;
  int executed_ = 0;
  std::exception_ptr failure_;
};

std::string Seconds(double seconds) {
  return cv::format(seconds < 10 ? "%.1f s" : "%.0f s", seconds);
}

}  // namespace

void SweepOptions::Check() const {
  constexpr int kMostJobs = 1024;
  CheckOption(!output.empty(), "output", "''", "a folder");
  CheckOption(jobs >= 1 && jobs <= kMostJobs, "jobs", jobs, "1..1024");
  CheckOption(threads >= 0, "threads", threads, "at least 0");
  const ChildLimits& limits = runner.limits;
  CheckOption(limits.wall_seconds >= 0, "max_wall_minutes",
              limits.wall_seconds / 60, "at least 0");
  CheckOption(limits.cpu_seconds >= 0, "max_cpu_minutes",
              limits.cpu_seconds / 60, "at least 0");
  CheckOption(limits.memory_bytes >= 0, "max_memory_gb",
              static_cast<double>(limits.memory_bytes) * 1e-9, "at least 0");
}

std::string SweepProgress::ToString() const {
  const TaskRecord& record = last.record;
  std::string text = std::to_string(done) + "/" + std::to_string(total) + " " +
                     record.task.name;
  if (IsFailure(last)) {
    text += " FAILED: " + record.Error();
  } else if (last.kept) {
    text += " kept";
    if (!last.evaluation.empty()) text += ", " + last.evaluation;
  } else {
    text += " done";
    if (std::isfinite(record.cost.wall_seconds)) {
      text += ", " + Seconds(record.cost.wall_seconds);
    }
    if (!record.reason.empty()) text += ", again: " + record.reason;
  }
  if (seconds_left > 0) text += ", " + Seconds(seconds_left) + " left";
  return text;
}

SweepOutcome RunSweep(const Experiment& experiment, const SweepOptions& options,
                      const SweepCallback& progress, const StopRequest& stop) {
  SweepOptions adding = options;
  adding.planned = [&] {
    if (options.planned) options.planned();
    MakeFolder(options.output);
    AddExperiment(ExperimentFolder(options.output), experiment);
  };
  return RunTasks(PlanTasks(experiment), adding, progress, stop);
}

SweepOutcome RunTasks(const std::vector<Task>& tasks,
                      const SweepOptions& options,
                      const SweepCallback& progress, const StopRequest& stop) {
  RunCommand command(options.run_program, options.threads);
  CheckBeforeRuns(tasks, options, &command);
  if (options.planned) options.planned();
  return SweepQueue(tasks, options, command, progress, stop).Run();
}

std::vector<PlannedTask> DryRun(const Experiment& experiment,
                                const SweepOptions& options) {
  return DryRun(PlanTasks(experiment), options);
}

std::vector<PlannedTask> DryRun(const std::vector<Task>& tasks,
                                const SweepOptions& options) {
  RunCommand command(options.run_program, options.threads);
  CheckBeforeRuns(tasks, options, &command);
  const ExperimentFolder folder(options.output);
  std::vector<PlannedTask> planned;
  planned.reserve(tasks.size());
  for (const Task& task : tasks) {
    planned.emplace_back(task, WhatIsToDo(folder, command, task));
  }
  return planned;
}

}  // namespace splitfusion
