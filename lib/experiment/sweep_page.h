#ifndef SPLITFUSION_LIB_EXPERIMENT_SWEEP_PAGE_H_
#define SPLITFUSION_LIB_EXPERIMENT_SWEEP_PAGE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/experiment_folder.h"
#include "splitfusion/lib/experiment/result_files.h"
#include "splitfusion/lib/experiment/result_statistics.h"
#include "splitfusion/lib/experiment/result_table.h"

namespace splitfusion {

/// A self-contained page about an experiment: of every figure a chart over the
/// key that has most values, with a line for each sequence and setting of the
/// other keys, means over the repeats with their standard errors; `tables` (the
/// means, and with a baseline differences and effects), and all runs with links
/// to their own pages. Runs without figures are counted, and say why.
///
/// `folder`: that of the experiment, where the page will be. `groups`:
/// GroupResults(table).
std::string SweepPage(const ExperimentFolder& folder, const ResultTable& table,
                      const std::vector<ResultGroup>& groups,
                      const std::vector<FileTable>& tables);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SWEEP_PAGE_H_
