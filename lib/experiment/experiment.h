#ifndef SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_H_
#define SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_H_

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/settings.h"

namespace splitfusion {

/// A sequence of an experiment.
struct SequenceEntry {
  std::string name;          ///< In tables and names of tasks.
  std::string folder;        ///< Absolute path.
  std::string ground_truth;  ///< Folder with groundtruth.txt; empty = none.
  Settings set;              ///< Options of this sequence alone.
};

/// A named group of options, such as one line of an ablation.
struct NamedSettings {
  std::string name;  ///< In the column `row`.
  Settings set;      ///< What it sets; may be empty.
};

/// What is to be run: every sequence with every row, every point of the grid or
/// of the random design, and every repeat.
struct Experiment {
  std::vector<SequenceEntry> sequences;  ///< At least one.
  Settings set;                          ///< Options of all runs.
  std::vector<Axis> grid;                ///< What is varied.
  int random = 0;          ///< Points of a random design; 0 = whole grid.
  std::uint64_t seed = 1;  ///< Of the random design.
  std::vector<NamedSettings> rows;  ///< Empty: one without name and options.
  int repeat = 1;                   ///< Runs of each; see ShiftVoxels().
  /// Name of a row, or settings, that differences are taken from; may be empty.
  std::string baseline;
  Settings evaluate;  ///< Flags of sf_evaluate.

  /// Number of runs; some of a random design may be the same.
  double Count() const;
  /// @throw InputError if there is nothing to run, or more than a million
  ///     runs, or as CheckFieldsAlone().
  void Check() const;
  /// The same of an experiment whose sequences are named elsewhere.
  ///
  /// @throw InputError if a name or a value occurs twice, or a key is one that
  ///     the sweep itself sets.
  void CheckFieldsAlone() const;
};

/// Reads an experiment file; its format is in docs/experiments.md. Relative
/// folders are relative to the file.
///
/// @throw InputError that names the file and the field.
Experiment ReadExperiment(const std::string& path);

/// The experiment of a JSON value whose relative folders are below `folder`.
///
/// @throw InputError that names the field.
Experiment ExperimentFromJson(const nlohmann::ordered_json& json,
                              const std::string& folder);

/// What SavedExperiment() reads back.
nlohmann::ordered_json ToJson(const Experiment& experiment);

/// An experiment as ToJson() wrote it; its folders may be gone since.
///
/// @throw InputError if it is damaged.
Experiment SavedExperiment(const nlohmann::ordered_json& json);

/// Settings of a JSON object; numbers and booleans become text.
///
/// @throw InputError if it is no object of plain values.
Settings SettingsFromJson(const nlohmann::ordered_json& json,
                          const std::string& field);

/// A JSON object of text values.
nlohmann::ordered_json ToJson(const Settings& settings);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_EXPERIMENT_H_
