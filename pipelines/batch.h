#ifndef SPLITFUSION_PIPELINES_BATCH_H_
#define SPLITFUSION_PIPELINES_BATCH_H_

#include <functional>
#include <vector>

#include "splitfusion/pipelines/batch_plan.h"
#include "splitfusion/pipelines/batch_summary.h"
#include "splitfusion/pipelines/child_process.h"

namespace splitfusion {

/// How far a batch is, after a run has ended.
struct BatchProgress {
  int done = 0;             ///< Runs ended, skipped ones included.
  int total = 0;            ///< Runs of the batch.
  double seconds_left = 0;  ///< Guess from the runs so far; 0 if there is none.
  BatchResult last;         ///< The run that has just ended.
};

/// Receives the progress; calls come one at a time, from any thread.
using BatchCallback = std::function<void(const BatchProgress&)>;

/// Runs sf_run, and sf_evaluate where there is a ground truth, for every
/// sequence and option file; see PlanBatch. What the programs say is in
/// RUN/run.log, RUN/run.err.log, RUN/evaluate.log, RUN/evaluate.err.log. A run
/// that fails is recorded and the batch goes on; a finished one (its
/// summary.json is there) is kept unless `overwrite`. The summary files of the
/// batch are brought up to date after every run. Once `stop` (may be empty; may
/// be asked from any thread) says so, what runs is asked to stop or killed, and
/// recorded as it ends, and no further run is started.
///
/// @return one result a run that was started or kept, in the order of the plan.
/// @throw InputError as PlanBatch, or if the output cannot be written.
std::vector<BatchResult> RunBatch(const BatchOptions& options,
                                  const BatchCallback& progress = {},
                                  const StopRequest& stop = {});

/// Number of runs that failed.
int CountFailed(const std::vector<BatchResult>& results);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_BATCH_H_
