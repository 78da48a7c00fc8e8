#ifndef SPLITFUSION_LIB_EXPERIMENT_TASK_EVALUATION_H_
#define SPLITFUSION_LIB_EXPERIMENT_TASK_EVALUATION_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/task.h"
#include "splitfusion/lib/experiment/task_record.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// What decides the evaluation of a run besides the run itself: the content of
/// the ground truth and the flags of sf_evaluate. Empty without ground truth.
NamedValues EvaluationParts(const Task& task);

/// Whether there was a ground truth that is no more.
bool GroundTruthIsGone(const Task& task);

/// The command that evaluates a run directory of a task.
std::vector<std::string> EvaluateCommand(const std::string& program,
                                         const Task& task,
                                         const std::string& run);

/// Why the evaluation of a run is not the one that sf_batch had made: status
/// of its row, and why it is made again; empty if it is, or if the record does
/// not tell.
///
/// @throw InputError if evaluation.json cannot be read.
std::string ForeignEvaluation(const TaskRecord& record, const std::string& run);

/// Whether sf_evaluate takes the flags of all tasks that have a ground truth.
///
/// @throw InputError with the flags and the last line of sf_evaluate if it does
///     not.
void CheckEvaluateFlags(const std::string& program,
                        const std::vector<Task>& tasks);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_TASK_EVALUATION_H_
