#ifndef SPLITFUSION_LIB_EXPERIMENT_ROW_FILE_H_
#define SPLITFUSION_LIB_EXPERIMENT_ROW_FILE_H_

#include <map>
#include <string>
#include <utility>

#include "splitfusion/lib/experiment/figures.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// What decides the figures of a run: its identity and, if it was evaluated,
/// EvaluationParts().
std::string RowKey(const std::string& identity, const NamedValues& evaluation);

/// Figures of finished runs by RowKey(), in a small CSV file that
/// outlives the run directories: identity, sequence, task, settings, and the
/// figures.
class RowFile {
 public:
  /// One run.
  struct Row {
    std::string task;      ///< Name of the task, for readers of the file.
    std::string sequence;  ///< Name of the sequence.
    std::string row;       ///< Name of the row.
    std::string settings;  ///< As SettingsText().
    double seconds = 0;    ///< Of the whole run, wall clock; NaN = unknown.
    Figures figures;       ///< All that are known.
  };

  RowFile() = default;
  /// Reads a file; a missing one has no rows.
  ///
  /// @throw InputError if a line is not what Write() writes.
  explicit RowFile(const std::string& path);

  /// Whether there is no row.
  bool empty() const { return rows_.empty(); }
  /// The row of a key and a sequence; null if there is none. The same
  /// images may be judged by another truth under another name.
  const Row* Find(const std::string& key, const std::string& sequence) const;
  /// Adds a row, or replaces the one of the same key and sequence.
  void Set(const std::string& key, const Row& row);
  /// Writes all rows, in the order of their tasks.
  ///
  /// @throw InputError if that is not possible.
  void Write(const std::string& path) const;

 private:
  /// By key and sequence.
  std::map<std::pair<std::string, std::string>, Row> rows_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_ROW_FILE_H_
