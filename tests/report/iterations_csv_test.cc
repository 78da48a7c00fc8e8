#include "splitfusion/lib/report/iterations_csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "splitfusion/lib/report/csv_row.h"
#include "support/sample_report.h"

namespace splitfusion {
namespace {

std::vector<std::string> Lines(const FrameReport& report) {
  std::stringstream stream;
  WriteIterationsHeader(stream);
  WriteIterations(stream, report);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(IterationsCsv, HasOneRowPerIteration) {
  const auto lines = Lines(SampleReport(5));
  ASSERT_EQ(lines.size(), 1u + 2 * 2);  // Header; two surfaces, two iterations.
  EXPECT_EQ(lines[4],
            "5,1,0,rigid,2,8,1,1,0.125,2.375,0.001,0.02,10000,7,0.005,0.004");
}

TEST(IterationsCsv, EveryRowHasTheColumnsOfTheHeader) {
  FrameReport report = SampleReport(0);
  report.surfaces[0].rounds[0].solver.iterations[0].cost =
      std::numeric_limits<double>::quiet_NaN();
  const auto lines = Lines(report);
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  for (const auto& line : lines) EXPECT_EQ(commas(line), commas(lines[0]));
  EXPECT_EQ(lines[1], "0,0,0,rigid,2,8,0,1,,0,0,0,0,0,0,0");
}

TEST(CsvRow, QuotesWhatWouldBreakTheTable) {
  CsvRow row;
  row.Add(std::string("plain")).Add(std::string("a,b")).Add(0.1);
  row.Add(std::string("say \"no\"")).Add(-2);
  EXPECT_EQ(row.text(), "plain,\"a,b\",0.1,\"say \"\"no\"\"\",-2");
}

}  // namespace
}  // namespace splitfusion
