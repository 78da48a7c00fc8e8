#ifndef SPLITFUSION_LIB_EXPERIMENT_RESULT_TABLE_H_
#define SPLITFUSION_LIB_EXPERIMENT_RESULT_TABLE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/experiment_folder.h"
#include "splitfusion/lib/experiment/figures.h"
#include "splitfusion/lib/experiment/row_file.h"
#include "splitfusion/lib/experiment/task_record.h"

namespace splitfusion {

/// One run in the table of an experiment.
struct ResultRow {
  Task task;                        ///< What was to be done.
  std::string status;               ///< "complete", or what else it is.
  std::string error;                ///< Last line of what failed.
  Figures figures;                  ///< Unknown unless it is complete.
  std::vector<std::string> values;  ///< By ResultTable::keys.
  std::string identity;             ///< Of a complete one; may be empty.
  NamedValues parts;         ///< RunIdentity::parts, where they are known.
  NamedValues evaluated_by;  ///< EvaluationParts() of its evaluation.
  std::string ended;         ///< When it was looked at last, TimeText().
  RunCost cost;              ///< Of the whole run.

  /// Whether its figures count.
  bool IsComplete() const { return status == "complete"; }
};

/// All runs of an experiment's folder.
struct ResultTable {
  /// What varies: `row` if there are rows, keys of grids, designs and rows, and
  /// keys in which runs of one sequence differ.
  std::vector<std::string> keys;
  std::vector<ResultRow> rows;  ///< In the order of the experiments.
};

/// Reads the table of an experiment from its run directories. What cannot be
/// read is the status "damaged: ..." of its row, what must not stand beside
/// newer rows "outdated: ..."; no row is left out.
///
/// @throw InputError if it is no folder of an experiment.
ResultTable CollectResults(const ExperimentFolder& folder);

/// The table of tasks before any of them has run: all are "waiting".
ResultTable PlannedTable(const std::vector<Task>& tasks);

/// Adds the finished rows of a table to a file of rows.
///
/// @throw InputError if it cannot be read or written.
void AddToRowFile(const ResultTable& table, const std::string& path);

/// Value of a key in a task; `row` is the row's name, empty if it is not set.
std::string ValueOf(const Task& task, const std::string& key);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RESULT_TABLE_H_
