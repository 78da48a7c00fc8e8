#ifndef SPLITFUSION_PIPELINES_REFINED_RUN_H_
#define SPLITFUSION_PIPELINES_REFINED_RUN_H_

#include <functional>
#include <string>

#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/report/run_folder.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// A finished run whose hidden motions are to be found anew, with other options
/// than it has; its images are not needed.
class RefinedRun {
 public:
  /// Reads the run. `freeze`: every n-th window of a surface becomes a frozen
  /// problem, FreezeWindow(); 0: none.
  ///
  /// @throw InputError if the folder holds no complete run, one that does not
  ///     say what was seen, or one in which a file is not as it was written;
  ///     OptionError if an option is out of its range.
  RefinedRun(std::string root, const HiddenMotionOptions& options,
             int freeze = 0);

  /// What decides the result: that of the run, the options, and that it began
  /// with what the run has.
  RunIdentity Identity() const;

  /// Copies what stays of the run into `folder`, fresh and not finished, writes
  /// motions.bin, warped meshes, refinement.jsonl, summary.json, report.html
  /// and options.flags anew, and puts it all into place. Returns the number of
  /// nodes that were hidden, each frame counted. Call it once. `shown` is told
  /// how many surfaces of how many are done.
  ///
  /// @throw InputError if a file cannot be read or written.
  int Write(RunFolder* folder, const std::function<void(int, int)>& shown);

 private:
  void CopyFiles(const RunPaths& to) const;
  void WriteOptions(const RunPaths& to) const;

  std::string root_;
  HiddenMotionOptions options_;
  int freeze_;
  RunMarker marker_;
  RecordedRun run_;  // Surfaces until they are written.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_REFINED_RUN_H_
