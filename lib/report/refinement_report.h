#ifndef SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_
#define SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_

#include <string>
#include <vector>

#include "splitfusion/lib/model/hidden_deviations.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// What a run says of its hidden motions; keys, columns and units in
/// docs/report_format.md.
struct RefinementReport {
  std::string windows;     ///< Lines of `refinement.jsonl`, one a window.
  std::string deviations;  ///< Rows of `hidden_deviations.csv`.

  /// Adds those of the surface with this id.
  void Add(int surface, const std::vector<RefinedWindow>& refined,
           const std::vector<HiddenDeviation>& sampled);

  /// Writes both files; no deviations, no file of them.
  ///
  /// @throw InputError if a file cannot be written.
  void Write(const RunPaths& paths) const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_
