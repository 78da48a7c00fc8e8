#ifndef SPLITFUSION_LIB_EXPERIMENT_TASK_RUNNER_H_
#define SPLITFUSION_LIB_EXPERIMENT_TASK_RUNNER_H_

#include <optional>
#include <string>

#include "splitfusion/lib/experiment/child_process.h"
#include "splitfusion/lib/experiment/experiment_folder.h"
#include "splitfusion/lib/experiment/row_file.h"
#include "splitfusion/lib/experiment/run_command.h"
#include "splitfusion/lib/experiment/task_record.h"

namespace splitfusion {

/// How tasks are run.
struct TaskRunnerOptions {
  std::string evaluate_program;  ///< Path of sf_evaluate.
  ChildLimits limits;            ///< Of sf_run, and of sf_evaluate.
  bool overwrite = false;        ///< Finished runs are done again.
  bool keep_failed = false;      ///< Failed ones are not tried again.
};

/// What became of a task.
struct TaskResult {
  bool passed_over = false;  ///< Another process works on it.
  bool kept = false;         ///< The run had been finished before.
  std::string evaluation;    ///< A remark on that of a kept run.
  bool stopped = false;      ///< Was asked to stop, and did.
  TaskRecord record;         ///< As it is now.
};

/// Runs single tasks of an experiment.
class TaskRunner {
 public:
  /// @param rows figures that count as done; may be empty.
  TaskRunner(ExperimentFolder folder, const RunCommand& command,
             TaskRunnerOptions options, RowFile rows, StopRequest stop);

  /// Does what is left to do of a task: sf_run, which keeps a finished run of
  /// the same identity, and sf_evaluate where there is a ground truth and its
  /// result is missing or older. All that goes wrong is recorded. A task that
  /// another process works on is passed over; one that another has ended since
  /// `known_attempts` is not tried again.
  ///
  /// @throw InputError if the task's folder cannot be written.
  TaskResult Run(const Task& task, int known_attempts) const;

 private:
  bool Reconstruct(TaskResult* result) const;
  ChildResult CallRun(const Task& task, bool keep) const;
  bool Evaluate(TaskResult* result) const;
  bool KeepEvaluation(TaskResult* result) const;
  ChildResult CallEvaluate(const Task& task) const;
  bool TakeRecorded(TaskRecord* record) const;
  bool Accept(const ChildResult& child, TaskRecord* record) const;

  ExperimentFolder folder_;
  const RunCommand& command_;
  TaskRunnerOptions options_;
  RowFile rows_;
  StopRequest stop_;
};

/// What running a task would do: "new", "finished", "changed: WHY" and so on.
std::string WhatIsToDo(const ExperimentFolder& folder,
                       const RunCommand& command, const Task& task);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_TASK_RUNNER_H_
