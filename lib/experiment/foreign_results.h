#ifndef SPLITFUSION_LIB_EXPERIMENT_FOREIGN_RESULTS_H_
#define SPLITFUSION_LIB_EXPERIMENT_FOREIGN_RESULTS_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/experiment_folder.h"

namespace splitfusion {

/// What another system made of a sequence.
struct ForeignResult {
  std::string system;      ///< Its name, in the column `row`.
  std::string sequence;    ///< Name of a sequence of the experiment.
  std::string trajectory;  ///< TUM file, world from camera.
  std::string background;  ///< PLY in that world; may be empty.
};

/// "NAME:SEQUENCE=TRAJECTORY[,BACKGROUND]; ...".
///
/// @throw InputError if it is written otherwise, or names a system twice on one
///     sequence.
std::vector<ForeignResult> ParseForeignResults(const std::string& text);

/// The rows that the results become.
///
/// @param tasks of the experiment.
/// @throw InputError if a sequence is none of theirs, or has no ground truth.
std::vector<Task> PlanForeign(const std::vector<Task>& tasks,
                              const std::vector<ForeignResult>& results);

/// Evaluates results of other systems against the ground truth of the
/// experiment's sequences, and keeps them in its folder as finished rows:
/// trajectory errors, and ghosts of the background.
///
/// @throw InputError if a file cannot be read, or the sequence is none of the
///     experiment or has no ground truth.
void AddForeignResults(const ExperimentFolder& folder,
                       const std::vector<ForeignResult>& results);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_FOREIGN_RESULTS_H_
