#ifndef SPLITFUSION_LIB_EXPERIMENT_TASK_H_
#define SPLITFUSION_LIB_EXPERIMENT_TASK_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/experiment.h"

namespace splitfusion {

/// One run of an experiment.
struct Task {
  /// SEQUENCE_HASH_rREPEAT, of the sequence's name, the row and the settings:
  /// wherever and in whatever order these were given, it is the same.
  std::string name;
  std::string sequence;         ///< Name of the sequence.
  std::string sequence_folder;  ///< Absolute path.
  std::string ground_truth;     ///< Folder with groundtruth.txt; empty = none.
  std::string row;              ///< Name of the row; empty = none.
  Settings settings;            ///< All options, those of the sequence, too.
  std::vector<std::string> design;   ///< Keys that a grid or design varies.
  std::vector<std::string> grouped;  ///< Keys that the row sets.
  int repeat = 0;                    ///< 0 = undisturbed.
  Settings evaluate;                 ///< Flags of sf_evaluate.
};

/// All tasks of an experiment: sequence by sequence, row by row, point by
/// point, repeat by repeat; none twice.
///
/// @throw InputError as Experiment::Check().
std::vector<Task> PlanTasks(const Experiment& experiment);

/// The row of another system on the sequence of a task, without options.
Task MakeForeignTask(const Task& task, const std::string& system);

/// What TaskFromJson() reads back.
nlohmann::ordered_json ToJson(const Task& task);

/// The task of a JSON object.
///
/// @throw InputError if a field is missing or has another type.
Task TaskFromJson(const nlohmann::ordered_json& json);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_TASK_H_
