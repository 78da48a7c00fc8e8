#ifndef SPLITFUSION_LIB_EXPERIMENT_SWEEP_H_
#define SPLITFUSION_LIB_EXPERIMENT_SWEEP_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/experiment/task_runner.h"

namespace splitfusion {

/// How the tasks of an experiment are run.
struct SweepOptions {
  std::string run_program;   ///< Path of sf_run.
  std::string output;        ///< Folder of the experiment.
  int jobs = 1;              ///< Runs at the same time.
  int threads = 0;           ///< Of a run that sets none; 0 = its default.
  bool fail_fast = false;    ///< Nothing is started after a failure.
  TaskRunnerOptions runner;  ///< How a task is run.
  std::string row_file;      ///< Figures that count as done; may be empty.
  /// Called before the first run, when nothing can be refused any more; may be
  /// empty.
  std::function<void()> planned;

  /// @throw InputError if a program is missing or a value out of its range.
  void Check() const;
};

/// How far a sweep is, after a task has ended.
struct SweepProgress {
  int done = 0;             ///< Tasks ended, kept ones included.
  int total = 0;            ///< Of the experiment.
  double seconds_left = 0;  ///< Guess from the runs so far; 0 if there is none.
  TaskResult last;          ///< The task that has just ended.

  /// "3/24 room_0123456789_r0 done, 12 s, 240 s left".
  std::string ToString() const;
};

/// Receives the progress; calls come one at a time, from any thread.
using SweepCallback = std::function<void(const SweepProgress&)>;

/// How a sweep ended.
struct SweepOutcome {
  int planned = 0;  ///< Tasks of the experiment.
  int ended = 0;    ///< Of these, complete or failed.
  int failed = 0;   ///< Of these, failed or not evaluated.
};

/// Runs all tasks of an experiment: adds it to its folder, looks at all options
/// before the first run, and goes through the tasks with `jobs` threads. Tasks
/// that another process works on are passed over, and looked at again at the
/// end. Every task that ends is a line of DIR/progress.log. Once `stop` (may be
/// empty; may be asked from any thread) says so, what runs is asked to stop or
/// killed, and nothing more is started.
///
/// @throw InputError if the experiment or its options are refused, or its
///     folder cannot be written.
SweepOutcome RunSweep(const Experiment& experiment, const SweepOptions& options,
                      const SweepCallback& progress = {},
                      const StopRequest& stop = {});

/// The same for tasks of an experiment that lies in the folder already.
///
/// @throw InputError as RunSweep.
SweepOutcome RunTasks(const std::vector<Task>& tasks,
                      const SweepOptions& options,
                      const SweepCallback& progress = {},
                      const StopRequest& stop = {});

/// A task, and what RunSweep() would do.
using PlannedTask = std::pair<Task, std::string>;

/// What RunSweep() would do, without doing it.
///
/// @throw InputError as RunSweep.
std::vector<PlannedTask> DryRun(const Experiment& experiment,
                                const SweepOptions& options);

/// What RunTasks() would do, without doing it.
///
/// @throw InputError as RunSweep.
std::vector<PlannedTask> DryRun(const std::vector<Task>& tasks,
                                const SweepOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SWEEP_H_
