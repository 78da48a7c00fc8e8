#include "growth_table.h"

#include <algorithm>
#include <limits>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/report/csv_row.h"

namespace splitfusion {

void GrowthTable::Write(const std::string& path) const {
  WriteFileAtomically(path, [this](std::ostream& out) {
    CsvRow header;
    for (const std::string& column : columns) header.Add(column);
    out << header.text() << '\n';
    for (const GrowthRow& row : rows) {
      CsvRow line;
      line.Add(row.x).Add(row.series);
      for (const double value : row.values) line.Add(value);
      out << line.text() << '\n';
    }
  });
}

std::string GrowthLabel(double value) { return CsvRow().Add(value).text(); }

std::string GrowthLabel(int value) { return std::to_string(value); }

double Fastest(int repetitions, const std::function<double()>& measure) {
  double fastest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    fastest = std::min(fastest, measure());
  }
  return fastest;
}

double FastestRun(int repetitions, const std::function<void()>& work) {
  return Fastest(repetitions, [&] {
    const Stopwatch stopwatch;
    work();
    return stopwatch.Seconds();
  });
}

}  // namespace splitfusion
