#ifndef SPLITFUSION_LIB_EXPERIMENT_RESULT_STATISTICS_H_
#define SPLITFUSION_LIB_EXPERIMENT_RESULT_STATISTICS_H_

#include <array>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/result_table.h"

namespace splitfusion {

/// Mean and scatter of some values.
struct Spread {
  int count = 0;                  ///< Values that are known.
  double mean = 0;                ///< NaN without values.
  double standard_deviation = 0;  ///< Of the sample (n - 1); NaN for n < 2.

  /// Of the mean: standard deviation / sqrt(n); NaN for n < 2.
  double StandardError() const;
};

/// Mean and scatter of the values that are finite.
Spread DescribeValues(const std::vector<double>& values);

/// Runs of one sequence with the same settings.
struct ResultGroup {
  std::string sequence;                             ///< Name, or kAllSequences.
  std::vector<std::string> values;                  ///< By ResultTable::keys.
  int runs = 0;                                     ///< Complete ones.
  int planned = 0;                                  ///< All.
  std::array<Spread, kFigureNames.size()> figures;  ///< By kFigureNames.
  Spread seconds;  ///< Of the whole run, wall clock.
};

/// Name in the column `sequence` of what is taken over all of them.
inline constexpr const char* kAllSequences = "(all)";

/// Means over the repeats, in the order of the table.
std::vector<ResultGroup> GroupResults(const ResultTable& table);

/// @param baseline a row's name, or "KEY=V; KEY=V".
/// @throw InputError if no run matches it, or it names a key that does not
///     vary.
void CheckBaseline(const ResultTable& table, const std::string& baseline);

/// Differences to a baseline.
struct Comparison {
  std::vector<ResultGroup> groups;  ///< Of every sequence.
  /// Effects, see EffectOn(), over the means of the sequences, so that each
  /// counts once; none of a single sequence.
  std::vector<ResultGroup> effects;
  int unpaired = 0;  ///< Complete runs that nothing can be compared with.
};

/// Differences to the baseline, run by run. The partner of a run is the
/// baseline's run of the same sequence and repeat that agrees with it in
/// everything else that decides results: in the resolved options, but for those
/// that the baseline's keys set, or, if it is a row, the keys of both rows.
/// Where such a key may set any option, as `preset` and `flagfile` do, the
/// other settings are compared instead. A foreign row has no settings: it is
/// compared if the baseline has one run alone.
///
/// @throw InputError as CheckBaseline().
Comparison CompareWithBaseline(const ResultTable& table,
                               const std::string& baseline);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RESULT_STATISTICS_H_
