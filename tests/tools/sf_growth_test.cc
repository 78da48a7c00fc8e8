// The growth curves' files and messages; no time is looked at.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

/// A file of sf_growth.
struct Curve {
  /// Every value of every row has to be a positive number.
  explicit Curve(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    columns = Split(line);
    while (std::getline(lines, line)) AddRow(Split(line));
  }

  void AddRow(const std::vector<std::string>& fields) {
    ASSERT_EQ(fields.size(), columns.size());
    x.insert(fields[0]);
    series.insert(fields[1]);
    for (std::size_t i = 2; i < fields.size(); ++i) {
      const double value = std::stod(fields[i]);
      EXPECT_TRUE(std::isfinite(value) && value > 0) << fields[i];
    }
    ++rows;
  }

  std::vector<std::string> columns;
  std::set<std::string> x, series;
  std::size_t rows = 0;
};

class SfGrowth : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_growth")) GTEST_SKIP() << "not built";
  }

  TemporaryFolder folder_;
};

TEST_F(SfGrowth, WritesEveryCurve) {
  const ProgramResult result =
      RunProgram("sf_growth", "--quick --output=" + (folder_ / "curves"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::set<std::string> solvers = {"gn_pcg", "gn_cholesky", "ceres"};
  const std::map<std::string, std::pair<std::string, std::set<std::string>>>
      expected = {
          {"nodes", {"nodes,series,seconds,linear_iterations", solvers}},
          {"correspondences",
           {"correspondences,series,seconds,linear_iterations", solvers}},
          {"voxels",
           {"voxel_size_m,series,seconds,bytes",
            {"fuse rigid", "fuse warped", "ray cast", "re-mesh"}}},
          {"people",
           {"people,series,seconds,surfaces",
            {"total", "total_one_thread", "solve", "fuse", "mesh"}}},
          {"one_graph",
           {"model,series,seconds,bytes,nodes",
            {"solve gn_pcg", "solve gn_cholesky", "fuse"}}}};
  for (const auto& [name, columns_and_series] : expected) {
    SCOPED_TRACE(name);
    const Curve curve(folder_.Read("curves/" + name + ".csv"));
    const auto& [columns, series] = columns_and_series;
    EXPECT_EQ(curve.columns, Split(columns));
    EXPECT_TRUE(std::includes(curve.series.begin(), curve.series.end(),
                              series.begin(), series.end()));
    EXPECT_GE(curve.x.size(), 2u);
    EXPECT_EQ(curve.rows, curve.x.size() * curve.series.size());
  }
}

TEST_F(SfGrowth, OneGraphNeedsMoreNodesThanSplitSurfaces) {
  const ProgramResult result =
      RunProgram("sf_growth",
                 "--quick --curve=one_graph --output=" + (folder_ / "curves"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_FALSE(folder_.Has("curves/nodes.csv"));
  std::map<std::string, double> nodes;
  std::istringstream lines(folder_.Read("curves/one_graph.csv"));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = Split(line);
    nodes[fields.front()] = std::stod(fields.back());
  }
  EXPECT_GT(nodes.at("one_graph_as_fine"), 2 * nodes.at("split"));
}

TEST_F(SfGrowth, RefusesWrongArgumentsBeforeItRuns) {
  ExpectRefused("sf_growth", "", "expected --output=DIR");
  ExpectRefused("sf_growth", "--output=/proc/none", "cannot be written");
  const std::string output = "--output=" + (folder_ / "curves");
  ExpectRefused("sf_growth", output + " --curve=time",
                "--curve = time: expected correspondences, nodes");
  ExpectRefused("sf_growth", output + " --threads=2", "unknown argument");
  EXPECT_FALSE(folder_.Has("curves"));
}

}  // namespace
}  // namespace splitfusion
