#ifndef SPLITFUSION_LIB_EXPERIMENT_RESULT_FILES_H_
#define SPLITFUSION_LIB_EXPERIMENT_RESULT_FILES_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/result_statistics.h"

namespace splitfusion {

/// A cell of a file: text, or a number if it reads as one; empty if unknown.
struct Cell {
  /// A text or a number, as it was given.
  Cell(std::string value);  // NOLINT: a row of cells is written as values.
  /// A number; NaN and infinity are unknown.
  Cell(double value);  // NOLINT: likewise.
  /// A count.
  Cell(int value);  // NOLINT: likewise.

  std::string text;        ///< As in CSV; empty = unknown.
  bool is_number = false;  ///< Whether SQLite stores a number,
  bool is_count = false;   ///< and a whole one.
  double number = 0;       ///< That number.
};

/// A table to be written.
struct FileTable {
  std::string name;                     ///< In SQLite.
  std::vector<std::string> columns;     ///< All different.
  std::vector<std::vector<Cell>> rows;  ///< By column.
};

/// `results`: task, sequence, repeat, status, the varied keys, the figures.
FileTable ResultsTable(const ResultTable& table);

/// `summary` of GroupResults(): sequence, the varied keys, n, planned, and of
/// every figure NAME_mean and NAME_sd.
FileTable SummaryTable(const ResultTable& table,
                       const std::vector<ResultGroup>& groups);

/// `differences` of CompareWithBaseline(): sequence, the varied keys, n, and of
/// every figure NAME_difference and NAME_se; seconds of a whole run.
FileTable DifferencesTable(const ResultTable& table,
                           const Comparison& comparison);

/// `effects` of CompareWithBaseline(): the same, with NAME_effect.
FileTable EffectsTable(const ResultTable& table, const Comparison& comparison);

/// Writes a CSV file, whole or not at all.
///
/// @throw InputError if it cannot be written.
void WriteCsv(const std::string& path, const FileTable& table);

/// Writes an SQLite file with these tables, whole or not at all.
///
/// @throw InputError if it cannot be written.
void WriteSqlite(const std::string& path, const std::vector<FileTable>& tables);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RESULT_FILES_H_
