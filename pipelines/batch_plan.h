#ifndef SPLITFUSION_PIPELINES_BATCH_PLAN_H_
#define SPLITFUSION_PIPELINES_BATCH_PLAN_H_

#include <string>
#include <vector>

namespace splitfusion {

/// What a batch consists of.
struct BatchOptions {
  std::string run_program;                ///< Path of sf_run.
  std::string evaluate_program;           ///< Path of sf_evaluate.
  std::vector<std::string> sequences;     ///< Sequence folders.
  std::vector<std::string> option_files;  ///< Flagfiles; empty = defaults only.
  std::string output;                     ///< Folder of the batch.
  int jobs = 1;                           ///< Runs at the same time.
  /// "auto" (SEQ/gt or SEQ, where groundtruth.txt is), "none", or a folder that
  /// holds one folder with a groundtruth.txt per sequence name.
  std::string ground_truth = "auto";
  bool overwrite = false;  ///< Repeat finished runs.

  /// @throw InputError if a path is missing or a value out of its range.
  void Check() const;
};

/// One sequence with one option file.
struct BatchRun {
  std::string sequence;         ///< Name: last part of the folder.
  std::string sequence_folder;  ///< Path.
  std::string options;      ///< Name: option file without extension, "default".
  std::string option_file;  ///< Path; empty for the defaults.
  std::string folder;       ///< Run directory, OUTPUT/SEQUENCE/OPTIONS.
  std::string ground_truth;  ///< Folder with groundtruth.txt; empty = none.
};

/// Sequence folders of `--sequences`: folders and list files, separated by
/// commas. A list has one folder a line, relative to the list, `#` comments.
///
/// @throw InputError if one does not exist, or there is none.
std::vector<std::string> ReadSequences(const std::string& text);

/// Every sequence with every option file, sequence by sequence.
///
/// @throw InputError as BatchOptions::Check(), or if two sequences or two
///     option files have the same name.
std::vector<BatchRun> PlanBatch(const BatchOptions& options);

/// Parts of a comma-separated list; empty parts are left out.
std::vector<std::string> SplitAtCommas(const std::string& text);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_BATCH_PLAN_H_
