#include "splitfusion/lib/experiment/result_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "splitfusion/lib/experiment/printed_table.h"
#include "splitfusion/lib/experiment/row_file.h"
#include "support/expect_input_error.h"
#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ResultRow Row(const std::string& sequence, const std::string& weight,
              int repeat, double ate) {
  ResultRow row;
  row.task.sequence = sequence;
  row.task.settings.Set("weight", weight);
  row.task.design = {"weight"};
  row.task.repeat = repeat;
  row.values = {weight};
  row.status = "complete";
  row.figures.At("ate_m") = ate;
  row.cost.wall_seconds = 2;
  return row;
}

/// Two sequences, two weights, two repeats; the second run of b/8 failed.
ResultTable Sample() {
  ResultTable table;
  table.keys = {"weight"};
  table.rows = {Row("a", "4", 0, 0.010), Row("a", "4", 1, 0.020),
                Row("a", "8", 0, 0.013), Row("a", "8", 1, 0.025),
                Row("b", "4", 0, 0.100), Row("b", "4", 1, 0.200),
                Row("b", "8", 0, 0.101), Row("b", "8", 1, 0.0)};
  table.rows.back().status = "failed";
  table.rows.back().figures = Figures();
  return table;
}

const Spread& Ate(const ResultGroup& group) { return group.figures[2]; }

TEST(ResultStatistics, RepeatsHaveMeanAndScatter) {
  const auto groups = GroupResults(Sample());
  ASSERT_EQ(groups.size(), 4u);
  EXPECT_EQ(Ate(groups[0]).count, 2);
  EXPECT_NEAR(Ate(groups[0]).mean, 0.015, 1e-12);
  EXPECT_NEAR(Ate(groups[0]).standard_deviation, 0.005 * std::sqrt(2), 1e-12);
  EXPECT_EQ(groups[3].runs, 1);
  EXPECT_EQ(groups[3].planned, 2);
  EXPECT_TRUE(std::isnan(Ate(groups[3]).standard_deviation));
}

TEST(ResultStatistics, DifferencesArePairedBySequenceAndRepeat) {
  const Comparison comparison = CompareWithBaseline(Sample(), "weight=4");
  const auto& groups = comparison.groups;
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].sequence, "a");
  EXPECT_NEAR(Ate(groups[0]).mean, 0.004, 1e-12);
  EXPECT_NEAR(Ate(groups[0]).StandardError(), 0.001, 1e-12);
  EXPECT_EQ(groups[1].runs, 1);
  EXPECT_EQ(groups[1].seconds.mean, 2);
}

TEST(ResultStatistics, EffectsCountEverySequenceOnce) {
  ResultTable table = Sample();
  for (ResultRow& row : table.rows) {
    row.figures.At("missing") = row.values[0] == "8" ? 0.03 : 0;
  }
  const auto effects = CompareWithBaseline(table, "weight=4").effects;
  ASSERT_EQ(effects.size(), 1u);
  EXPECT_EQ(effects[0].sequence, kAllSequences);
  EXPECT_EQ(effects[0].runs, 3);
  const double a = (std::log(1.3) + std::log(1.25)) / 2, b = std::log(1.01);
  EXPECT_EQ(Ate(effects[0]).count, 2);
  EXPECT_NEAR(Ate(effects[0]).mean, (a + b) / 2, 1e-12);
  EXPECT_NEAR(Ate(effects[0]).StandardError(), (a - b) / 2, 1e-12);
  const Spread& missing = effects[0].figures[FigureColumn("missing")];
  EXPECT_NEAR(missing.mean, 0.03, 1e-12);
  table.rows.resize(4);
  EXPECT_TRUE(CompareWithBaseline(table, "weight=4").effects.empty());
}

TEST(ResultStatistics, OtherDesignKeysStayTheSame) {
  ResultTable table = Sample();
  table.keys = {"weight", "voxel"};
  table.rows.clear();
  for (const char* voxel : {"1", "2"}) {
    for (const char* weight : {"4", "8"}) {
      const double ate = std::atof(voxel) * std::atof(weight);
      table.rows.push_back(Row("a", weight, 0, ate));
      table.rows.back().task.settings.Set("voxel", voxel);
      table.rows.back().values.emplace_back(voxel);
    }
  }
  const auto groups = CompareWithBaseline(table, "weight=4").groups;
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(Ate(groups[0]).mean, 4);
  EXPECT_EQ(Ate(groups[1]).mean, 8);
}

TEST(ResultStatistics, RowsAreComparedByName) {
  ResultTable table = Sample();
  table.keys = {"row", "weight"};
  table.rows = {Row("a", "4", 0, 0.1), Row("a", "8", 0, 0.3)};
  for (ResultRow& row : table.rows) row.task.grouped = {"weight"};
  table.rows[0].task.row = "base";
  table.rows[1].task.row = "stiff";
  table.rows[0].values = {"base", "4"};
  table.rows[1].values = {"stiff", "8"};
  const auto groups = CompareWithBaseline(table, "base").groups;
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_NEAR(Ate(groups[0]).mean, 0.2, 1e-12);
  ExpectInputError([&] { CompareWithBaseline(table, "none"); }, "baseline");
  ExpectInputError([&] { CompareWithBaseline(table, "x=1"); }, "x does not");
}

/// Runs of weights and values of another key.
ResultTable TwoKeys(
    const std::string& key,
    const std::vector<std::pair<std::string, std::string>>& runs) {
  ResultTable table;
  table.keys = {"weight", key};
  for (const auto& [weight, value] : runs) {
    table.rows.push_back(Row("a", weight, 0, 0.1));
    table.rows.back().task.settings.Set(key, value);
    table.rows.back().values.push_back(value);
  }
  return table;
}

TEST(ResultStatistics, RunsOfOtherSettingsAreNoPartners) {
  for (const char* key : {"object_voxel", "max_frames"}) {
    const Comparison comparison =
        CompareWithBaseline(TwoKeys(key, {{"8", "5"}, {"4", "8"}}), "weight=8");
    EXPECT_TRUE(comparison.groups.empty());
    EXPECT_EQ(comparison.unpaired, 1);
  }
  // Common options differ, which no grid does.
  const Comparison exact = CompareWithBaseline(
      TwoKeys("max_frames", {{"4", "3"}, {"8", "3"}, {"4", "4"}, {"8", "4"}}),
      "weight=8");
  EXPECT_EQ(exact.groups.size(), 2u);
  EXPECT_EQ(exact.unpaired, 0);
}

TEST(ResultStatistics, PartnersHaveTheSameResolvedOptions) {
  ResultTable table = TwoKeys("voxel", {{"8", "5"}, {"4", ""}});
  const NamedValues common = {{"voxel", "5"}, {"lambda", "1"}};
  for (ResultRow& row : table.rows) {
    row.parts = common;
    row.parts["weight"] = ValueOf(row.task, "weight");
  }
  EXPECT_EQ(CompareWithBaseline(table, "weight=8").unpaired, 0);
  table.rows[1].parts["lambda"] = "2";  // As where a flagfile was edited.
  EXPECT_EQ(CompareWithBaseline(table, "weight=8").unpaired, 1);
}

TEST(ResultStatistics, TermsAreAllTheirOptions) {
  ResultTable table;
  table.keys = {"terms"};
  for (const std::string weight : {"4", "8"}) {
    ResultRow& row = table.rows.emplace_back(Row("a", weight, 0, 0.01));
    row.task.settings = Settings();
    row.task.settings.Set("terms", "arap person.arap(weight=" + weight + ")");
    row.task.design = {"terms"};
    row.values = {*row.task.settings.Find("terms")};
    row.parts = {{"terms", "arap"},
                 {"terms.arap.weight", "1"},
                 {"person.terms.arap.weight", weight}};
  }
  const std::string baseline = "terms=\"" + table.rows[0].values[0] + "\"";
  EXPECT_EQ(CompareWithBaseline(table, baseline).unpaired, 0);
  table.rows[1].parts["lambda"] = "2";
  EXPECT_EQ(CompareWithBaseline(table, baseline).unpaired, 1);
}

TEST(ResultStatistics, AForeignRowIsComparedIfItIsClearWithWhat) {
  ResultTable table = TwoKeys("x", {{"8", "1"}, {"4", "1"}});
  for (ResultRow& row : table.rows) row.identity = "known";
  table.rows.push_back(Row("a", "", 0, 0.1));
  table.rows.back().task.settings = Settings();
  table.rows.back().task.row = "other system";
  table.rows.back().values = {"", ""};
  EXPECT_EQ(CompareWithBaseline(table, "weight=8").groups.size(), 2u);
  EXPECT_EQ(CompareWithBaseline(table, "x=1").unpaired, 1);
}

void ExpectWidth(const std::string& text, std::size_t width) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    EXPECT_LE(line.size(), width) << line;
  }
}

TEST(PrintedTable, ShowsWhatVariesAndIsKnown) {
  const ResultTable table = Sample();
  const std::string text = PrintedSummary(table, GroupResults(table), 80);
  EXPECT_THAT(text, HasSubstr("sequence  weight    n         ATE mm\n"));
  EXPECT_THAT(text, HasSubstr("a         4         2    15.00+-7.07\n"));
  EXPECT_THAT(text, HasSubstr("1/2"));
  EXPECT_THAT(text, Not(HasSubstr("ghosts")));
  const std::string differences = PrintedDifferences(
      table, CompareWithBaseline(table, "weight=4"), "weight=4", 80);
  EXPECT_THAT(differences, HasSubstr("+4.00+-1.00"));
  // 100 times the log ratios: ATE of a: 24.3, of b: 1.0.
  EXPECT_THAT(differences, HasSubstr("ATE %\n(all)"));
  EXPECT_THAT(differences, HasSubstr("+12.6+-11.6"));
}

TEST(PrintedTable, WhatTellsMostComesFirstBehindTheTrajectory) {
  ResultTable table = Sample();
  int number = 0;
  for (ResultRow& row : table.rows) {
    const double weight = row.values[0] == "8" ? 1 : 0;
    const double noise = ++number % 3 == 0 ? 0.1 : 0;
    row.figures.At("f_score_seen") = 0.5 + 0.01 * weight + noise;
    row.figures.At("stretched") = 0.2 + 0.1 * weight + 1e-7 * noise;
  }
  const std::string text = PrintedSummary(table, GroupResults(table), 66);
  const std::string heads = text.substr(0, text.find('\n'));
  EXPECT_THAT(heads, HasSubstr("weight    n"));
  EXPECT_THAT(heads, HasSubstr("ATE mm          stretched %"));
  EXPECT_THAT(text, HasSubstr("+-0.000001"));
  EXPECT_THAT(text.substr(heads.size()), HasSubstr("F seen %"));
  const std::string differences = PrintedDifferences(
      table, CompareWithBaseline(table, "weight=4"), "weight=4", 66);
  EXPECT_THAT(differences, HasSubstr("stretched %\n"));
  EXPECT_THAT(differences, HasSubstr("F seen %."));
  EXPECT_THAT(PrintedDifferences(table, {{}, {}, 2}, "weight=4", 100),
              HasSubstr("2 runs are not compared"));
}

TEST(PrintedTable, HeadingsAreDocumented) {
  std::ifstream stream(RepositoryRoot() / "docs/experiments.md");
  if (!stream) GTEST_SKIP() << "not built in the repository";
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  ResultTable table = Sample();
  table.rows[0].figures.values.fill(1);
  std::string text = PrintedSummary(table, GroupResults(table), 1000);
  std::string heads = text.substr(0, text.find('\n'));
  text = PrintedDifferences(table, {GroupResults(table), GroupResults(table)},
                            "weight=4", 1000);
  text.erase(0, text.find("Effects over"));
  text.erase(0, text.find('\n') + 1);
  heads += "  " + text.substr(text.find("s/run"),
                              text.find('\n') - text.find("s/run"));
  const std::regex between("  +");
  std::sregex_token_iterator head(heads.begin(), heads.end(), between, -1), end;
  int count = 0;
  for (std::advance(head, 2); head != end; ++head, ++count) {
    EXPECT_THAT(page, HasSubstr("`" + head->str() + "`"));
  }
  // The number of runs and all figures; seconds of a run and all effects.
  EXPECT_EQ(count, 17 + 17);
}

TEST(PrintedTable, IsNeverWiderThanTheTerminal) {
  ResultTable table = Sample();
  for (int i = 0; i < 6; ++i) {
    table.keys.push_back("terms.point_to_plane.scale" + std::to_string(i));
  }
  int number = 0;
  for (ResultRow& row : table.rows) {
    row.task.sequence += "_a_sequence_with_quite_a_long_name_of_its_own";
    row.figures.values.fill(1.2345e-3);
    while (row.values.size() < table.keys.size()) {
      row.values.push_back("point_to_plane(weight=1,loss=tukey,scale=0.03)" +
                           std::to_string(++number));
    }
  }
  for (const std::size_t width : {20u, 40u, 80u, 120u, 300u}) {
    const auto groups = GroupResults(table);
    const std::string text = PrintedSummary(table, groups, width);
    ExpectWidth(text, width);
    ExpectWidth(
        PrintedDifferences(table, {groups, groups, 0}, "weight=4", width),
        width);
    if (width < 80) continue;
    EXPECT_THAT(text, HasSubstr("F seen %"));
    EXPECT_THAT(text, HasSubstr("Not shown (in the files):"));
  }
}

TEST(RowFile, IsReadBackAsItWasWritten) {
  const TemporaryFolder folder;
  RowFile file(folder / "none.csv");
  RowFile::Row row{"t_r0", "room", "", R"(x="a,b"; y=1)", 1.5, {}};
  row.figures.At("ate_m") = 0.1;
  file.Set("0123", row);
  file.Write(folder / "rows.csv");
  const RowFile read(folder / "rows.csv");
  ASSERT_NE(read.Find("0123", "room"), nullptr);
  EXPECT_EQ(read.Find("0123", "room")->settings, row.settings);
  EXPECT_EQ(read.Find("0123", "room")->figures.At("ate_m"), 0.1);
  EXPECT_TRUE(std::isnan(read.Find("0123", "room")->figures.At("rpe_m")));
  EXPECT_EQ(read.Find("0123", "room")->seconds, 1.5);
  EXPECT_EQ(read.Find("0123", "desk"), nullptr);
  EXPECT_EQ(read.Find("4567", "room"), nullptr);
  folder.Write("rows.csv", folder.Read("rows.csv") + "half,a\n");
  ExpectInputError([&] { RowFile(folder / "rows.csv"); }, "line 3");
}

}  // namespace
}  // namespace splitfusion
