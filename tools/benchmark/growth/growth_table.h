#ifndef SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_TABLE_H_
#define SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_TABLE_H_

#include <functional>
#include <string>
#include <vector>

namespace splitfusion {

/// One measured point of a curve.
struct GrowthRow {
  std::string x;               ///< What grows.
  std::string series;          ///< Which line of the plot.
  std::vector<double> values;  ///< Seconds first.
};

/// One curve: seconds, and perhaps more, against what grows.
struct GrowthTable {
  std::vector<std::string> columns;  ///< Of x, series and every value.
  std::vector<GrowthRow> rows;       ///< In the order of the measurement.

  /// Writes a CSV file with a header, through a temporary name.
  ///
  /// @throw InputError if the file cannot be written.
  void Write(const std::string& path) const;
};

/// Shortest text of a number of metres that grows.
std::string GrowthLabel(double value);

/// Text of a count that grows.
std::string GrowthLabel(int value);

/// Least of the seconds that `measure` returns in so many calls: whatever else
/// the machine does only adds to them.
double Fastest(int repetitions, const std::function<double()>& measure);

/// Seconds that `work` takes, see Fastest().
double FastestRun(int repetitions, const std::function<void()>& work);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_GROWTH_GROWTH_TABLE_H_
