#include "splitfusion/lib/experiment/sweep_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ResultRow Row(const std::string& weight, const std::string& solver, int repeat,
              double ate) {
  ResultRow row;
  row.task.name = "desk_" + weight + solver + "_r" + std::to_string(repeat);
  row.task.sequence = "desk";
  row.task.settings.Set("weight", weight);
  row.task.settings.Set("solver", solver);
  row.task.design = {"weight", "solver"};
  row.task.repeat = repeat;
  row.values = {weight, solver};
  row.status = "complete";
  row.figures.At("ate_m") = ate;
  return row;
}

ResultTable Sample() {
  ResultTable table;
  table.keys = {"weight", "solver"};
  for (const char* weight : {"16", "4", "8"}) {
    table.rows.push_back(Row(weight, "pcg", 0, 0.01));
    table.rows.push_back(Row(weight, "pcg", 1, 0.03));
  }
  table.rows.push_back(Row("4", "ceres", 0, 0.5));
  table.rows.back().status = "failed";
  table.rows.back().error = "a < b";
  table.rows.back().figures = Figures();
  return table;
}

TEST(SweepPage, DrawsMeansWithTheirStandardErrors) {
  const TemporaryFolder folder;
  const ResultTable table = Sample();
  const std::string page =
      SweepPage(ExperimentFolder(folder / ""), table, GroupResults(table), {});
  // Values by size, not as texts.
  EXPECT_THAT(page, HasSubstr(R"("x_names":["4","8","16"])"));
  EXPECT_THAT(page, HasSubstr(R"("name":"desk solver=pcg",)"
                              R"("values":[0.02,0.02,0.02],)"
                              R"("spread":[0.01,)"));
  EXPECT_THAT(page, HasSubstr("6 of 7 runs are complete"));
  EXPECT_THAT(
      page,
      HasSubstr("desk_4ceres_r0 weight=4; solver=ceres: failed: a &lt; b"));
  // Figures that no run has are not drawn, nor is what failed.
  EXPECT_THAT(page, HasSubstr(R"("title":"ate_m over weight")"));
  EXPECT_THAT(page, Not(HasSubstr(R"("title":"rpe_m)")));
  EXPECT_THAT(page, Not(HasSubstr("\"name\":\"desk solver=ceres\"")));
}

TEST(SweepPage, LongValuesHaveLetters) {
  const TemporaryFolder folder;
  ResultTable table = Sample();
  for (ResultRow& row : table.rows) row.values[0] += ",a value < of many words";
  const std::string page =
      SweepPage(ExperimentFolder(folder / ""), table, GroupResults(table), {});
  EXPECT_THAT(page, HasSubstr(R"("x_names":["A","B","C"])"));
  EXPECT_THAT(page, HasSubstr("<li>A: 16,a value &lt; of many words</li>"));
}

TEST(SweepPage, LinksToPagesThatAreThere) {
  const TemporaryFolder folder;
  folder.Write("tasks/desk_4pcg_r1/run/report.html", "");
  const ResultTable table = Sample();
  const std::string page =
      SweepPage(ExperimentFolder(folder / ""), table, GroupResults(table),
                {SummaryTable(table, GroupResults(table))});
  EXPECT_THAT(page,
              HasSubstr("<a href=\"tasks/desk_4pcg_r1/run/report.html\">"));
  EXPECT_THAT(page, Not(HasSubstr("tasks/desk_4pcg_r0/run")));
  EXPECT_THAT(page, HasSubstr("<th>ate_m_mean</th>"));
}

}  // namespace
}  // namespace splitfusion
