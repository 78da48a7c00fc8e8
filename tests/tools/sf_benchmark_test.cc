// The benchmark programme's table, JSON and messages; no time is looked at.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SfBenchmark : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_benchmark")) GTEST_SKIP() << "not built";
  }

  /// Once, as short as it gets.
  static ProgramResult Run(const std::string& arguments) {
    return RunProgram(
        "sf_benchmark",
        "--benchmark_repetitions=1 --benchmark_min_time=0.001 " + arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(SfBenchmark, WritesTimesAndFloors) {
  const std::string file = folder_ / "times.json";
  const ProgramResult result =
      Run("--filter='integrate_rigid$' --json=" + file);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("over floor"));
  EXPECT_THAT(result.output, HasSubstr("\nintegrate_rigid "));
  const auto json = nlohmann::json::parse(folder_.Read("times.json"));
  ASSERT_EQ(json.size(), 1u);
  const auto& row = json.at("integrate_rigid");
  EXPECT_GT(row.at("floor"), 0);
  EXPECT_DOUBLE_EQ(row.at("over_floor"), row.at("time").get<double>() /
                                             row.at("floor").get<double>());
}

TEST_F(SfBenchmark, AnIterationBringsItsCompanions) {
  const ProgramResult result =
      Run("--filter='^gn_iteration$' --json=" + (folder_ / "times.json"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(folder_.Read("times.json"));
  const auto& row = json.at("gn_iteration");
  for (const char* key :
       {"time", "floor", "over_floor", "reference_36_over_gn_pcg",
        "reference_36_over_ceres_grouped", "custom_term_over_builtin"}) {
    EXPECT_GT(row.at(key), 0) << key;
  }
}

TEST_F(SfBenchmark, SkipsWhatHasNoInput) {
  const ProgramResult result = Run("--filter=network");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("skipped: no network given"));
}

TEST_F(SfBenchmark, ARowThatFailsIsAnError) {
  const std::string model = folder_.Write("model.onnx", "no network");
  const std::string file = folder_ / "times.json";
  ASSERT_EQ(setenv("SPLITFUSION_MODEL", model.c_str(), 1), 0);
  const ProgramResult result = Run("--filter=network --json=" + file);
  unsetenv("SPLITFUSION_MODEL");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("sf_benchmark: network: "));
  EXPECT_FALSE(folder_.Has("times.json"));
}

TEST_F(SfBenchmark, LeavesTheUsersFilesAlone) {
  folder_.Write("times.json.tmp", "mine");
  Run("--filter=nothing --json=" + (folder_ / "times.json"));
  EXPECT_EQ(folder_.Read("times.json.tmp"), "mine");
  EXPECT_FALSE(folder_.Has("times.json"));
}

TEST_F(SfBenchmark, RefusesWrongArgumentsBeforeItRuns) {
  for (const auto& [arguments, message] :
       {std::pair("--json=/nowhere/times.json", "cannot be written"),
        std::pair("--filter=nothing", "to match a benchmark's name"),
        std::pair("--filter='('", "a regular expression"),
        std::pair("--threads=2", "unknown argument")}) {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_THAT(result.output, IsEmpty()) << arguments;
    EXPECT_THAT(result.errors, HasSubstr(message));
  }
}

}  // namespace
}  // namespace splitfusion
