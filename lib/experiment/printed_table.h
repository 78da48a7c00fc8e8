#ifndef SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_
#define SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/experiment/result_statistics.h"

namespace splitfusion {

/// Means and scatters as a table for a terminal: what varies, what is not
/// complete, and the figures that are known, the most telling ones first. No
/// line is wider than `width`: what does not fit is named below.
std::string PrintedSummary(const ResultTable& table,
                           const std::vector<ResultGroup>& groups,
                           std::size_t width);

/// The same of differences to a baseline, with standard errors.
std::string PrintedDifferences(const ResultTable& table,
                               const std::vector<ResultGroup>& groups,
                               const std::string& baseline, std::size_t width);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_PRINTED_TABLE_H_
