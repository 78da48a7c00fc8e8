#ifndef SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_FOLDER_H_
#define SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_FOLDER_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/task.h"

namespace splitfusion {

/// Names of everything in the folder of an experiment.
class ExperimentFolder {
 public:
  /// Nothing is touched on disk.
  explicit ExperimentFolder(std::string root);

  /// DIR
  const std::string& root() const { return root_; }
  std::string Experiments() const;  ///< DIR/experiments
  std::string Tasks() const;        ///< DIR/tasks
  std::string Progress() const;     ///< DIR/progress.log
  /// DIR/tasks/TASK
  std::string TaskFolder(const std::string& task) const;
  /// DIR/tasks/TASK/run
  std::string Run(const std::string& task) const;
  /// DIR/tasks/TASK/lock
  std::string Lock(const std::string& task) const;

  /// A file in DIR.
  std::string Below(const std::string& name) const;

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
