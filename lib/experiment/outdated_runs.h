#ifndef SPLITFUSION_LIB_EXPERIMENT_OUTDATED_RUNS_H_
#define SPLITFUSION_LIB_EXPERIMENT_OUTDATED_RUNS_H_

#include <string>

#include "splitfusion/lib/experiment/result_table.h"

namespace splitfusion {

/// Gives complete runs that must not stand beside newer ones the status
/// "outdated: WHY" and takes their figures away: repeats whose options, input
/// or program are not those of the newest repeat, as after a change of their
/// flagfile; and runs that were judged by another ground truth or with other
/// flags than the newest run of their sequence.
void MarkOutdated(ResultTable* table);

/// The same for one run.
void MarkOutdated(const std::string& why, ResultRow* row);

/// How many runs are outdated, and why the first one is, as one line; empty if
/// none is.
std::string OutdatedText(const ResultTable& table);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_OUTDATED_RUNS_H_
