#ifndef SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_
#define SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/result_statistics.h"

namespace splitfusion {

/// Means and scatters as a table for a terminal: what varies, what is not
/// complete, and the figures that are known. Those come first whose largest
/// difference within a sequence is the most scatters (pooled over the lines);
/// without scatter, those that differ at all. No line is wider than `width`:
/// what does not fit is named below.
std::string PrintedSummary(const ResultTable& table,
                           const std::vector<ResultGroup>& groups,
                           std::size_t width);

/// The same of differences to a baseline, with standard errors; the largest
/// difference counts. A line tells of runs that were not compared. Then the
/// effects over all sequences, ratios as 100 times their logarithm.
std::string PrintedDifferences(const ResultTable& table,
                               const Comparison& comparison,
                               const std::string& baseline, std::size_t width);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_
