#ifndef SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_FOLDER_H_
#define SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_FOLDER_H_

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/experiment/task.h"

namespace splitfusion {

/// Names of everything in the folder of an experiment.
class ExperimentFolder {
 public:
  /// Nothing is touched on disk.
  explicit ExperimentFolder(std::string root) : root_(std::move(root)) {}

  /// DIR
  const std::string& root() const { return root_; }
  /// A file or folder in DIR.
  std::string Below(const std::string& name) const {
    return (std::filesystem::path(root_) / name).string();
  }
  /// DIR/experiments
  std::string Experiments() const { return Below("experiments"); }
  /// DIR/tasks
  std::string Tasks() const { return Below("tasks"); }
  /// DIR/progress.log
  std::string Progress() const { return Below("progress.log"); }
  /// DIR/tasks/TASK
  std::string TaskFolder(const std::string& task) const {
    return Below("tasks/" + task);
  }
  /// DIR/tasks/TASK/run
  std::string Run(const std::string& task) const {
    return TaskFolder(task) + "/run";
  }
  /// DIR/tasks/TASK/lock
  std::string Lock(const std::string& task) const {
    return TaskFolder(task) + "/lock";
  }

 private:
  std::string root_;
};

/// Adds an experiment to those that were run into the folder, unless it is
/// there.
///
/// @throw InputError if it cannot be written, or a name of its sequences stands
///     for another folder here, which would mix their rows.
void AddExperiment(const ExperimentFolder& folder,
                   const Experiment& experiment);

/// Whether an experiment was run into the folder; false if files of another
/// program lie there under the same names.
bool IsExperiment(const ExperimentFolder& folder);

/// Tasks of all experiments that were run into the folder, in the order of
/// these, and whatever else lies there.
///
/// @throw InputError if it is not IsExperiment().
std::vector<Task> KnownTasks(const ExperimentFolder& folder);

/// Baseline of the last experiment that names one; empty if none does.
std::string KnownBaseline(const ExperimentFolder& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_FOLDER_H_
