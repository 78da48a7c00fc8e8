#ifndef SPLITFUSION_LIB_EXPERIMENT_SLURM_ARRAY_H_
#define SPLITFUSION_LIB_EXPERIMENT_SLURM_ARRAY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/sweep.h"

namespace splitfusion {

/// What arrays of Slurm are made of, in which an element runs one task.
struct SlurmArray {
  /// sf_batch and its arguments, but for the number of the task.
  std::vector<std::string> command;
  std::string log_folder;      ///< Absolute path.
  int tasks = 0;               ///< All together.
  int cpus = 1;                ///< Of an element.
  std::int64_t mebibytes = 0;  ///< Memory of an element; 0 = the site's.
  std::int64_t minutes = 0;    ///< Time of an element; 0 = the site's.
  int max_array = 1001;        ///< Elements of an array: MaxArraySize.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// The tasks that a run would not just keep; of failed ones unless these are
/// kept, too.
std::vector<Task> UnfinishedTasks(const std::vector<PlannedTask>& tasks,
                                  bool keep_failed);

/// The arrays that run tasks as the options say. An element has the threads of
/// the task that takes most; memory and time are the limits of a run and what
/// sf_batch and the evaluation need on top of that, so that it is sf_batch that
/// ends a run beyond them, and records why.
///
/// @param program path of sf_batch.
/// @param list path that WriteTaskList() returned for the tasks.
SlurmArray MakeSlurmArray(const std::vector<Task>& tasks,
                          const SweepOptions& options,
                          const std::string& program, const std::string& list);

/// A script for sh that submits the arrays by sbatch, which gets the script's
/// own arguments, too. Element i of the array that begins with line n of the
/// list runs task n + i.
///
/// @throw InputError as SlurmArray::Check().
std::string SlurmScript(const SlurmArray& array);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SLURM_ARRAY_H_
