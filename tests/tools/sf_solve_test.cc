// Problems of a run, replayed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "sf_run_fixture.h"
#include "support/expect_refused.h"
#include "support/repository.h"

namespace splitfusion {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

/// Fields of every line of a CSV file without quotes.
std::vector<std::vector<std::string>> Csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      rows.back().push_back(field);
    }
  }
  return rows;
}

class SfSolve : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (!HasProgram("sf_solve")) GTEST_SKIP() << "sf_solve is not built";
  }

  /// Files of a run with frozen problems, by their order.
  std::vector<std::string> FrozenRun(const std::string& output) const {
    const ProgramResult result =
        Run(output, "--freeze=2 --pictures_every=0 --warped_every=0");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::set<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(
             folder_ / (output + "/problems"))) {
      files.insert(entry.path().string());
    }
    return {files.begin(), files.end()};
  }
};

TEST_F(SfSolve, ReplaysTheProblemsOfARun) {
  Synthesize();
  const std::vector<std::string> files = FrozenRun("run");
  // Room and person in frame 2, the person twice; frame 0 has no model.
  ASSERT_EQ(files.size(), 3u);
  std::string list;
  for (const std::string& file : files) list += file + " ";
  const ProgramResult result = RunProgram(
      "sf_solve", list +
                      "--solvers=gn_pcg,gn_cholesky,ceres --repeat=2 "
                      "--starts=warm,cold --output=" +
                      (folder_ / "out"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("3 problems; their first costs and "
                                       "gradients are the run's, to "));
  EXPECT_EQ(result.errors.find("warning"), std::string::npos) << result.errors;
  const auto rows = Csv(folder_.Read("out/solvers.csv"));
  ASSERT_EQ(rows.size(), 1u + 3 * 3 * 2 * 2);
  EXPECT_EQ(rows[0],
            (std::vector<std::string>{
                "problem", "solver", "preconditioner", "threads", "start",
                "repeat", "status", "iterations", "linear_iterations",
                "initial_cost", "final_cost", "seconds", "seconds_to_1e-2",
                "seconds_to_1e-4", "seconds_to_1e-6"}));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i][0], i <= 12   ? "000002_000"
                          : i <= 24 ? "000002_001"
                                    : "000002_001_first");
    EXPECT_LE(std::stod(rows[i][10]), std::stod(rows[i][9]));
  }
  for (const char* figure : {"profile_1e-2", "profile_1e-4", "profile_1e-6",
                             "gap_over_time", "gap_over_iterations"}) {
    EXPECT_TRUE(folder_.Has(std::string("out/") + figure + ".svg")) << figure;
  }
  // An earlier result is kept unless it may be replaced.
  ExpectRefused("sf_solve", list + "--output=" + (folder_ / "out"), "out");
  EXPECT_EQ(RunProgram("sf_solve", files[0] + " --solvers=gn_pcg --overwrite " +
                                       "--output=" + (folder_ / "out"))
                .exit_code,
            0);
  EXPECT_EQ(Csv(folder_.Read("out/solvers.csv")).size(), 2u);
}

TEST_F(SfSolve, FreezingChangesNothingOfARun) {
  Synthesize();
  const std::vector<std::string> files = FrozenRun("frozen");
  ASSERT_EQ(Run("plain", "--pictures_every=0 --warped_every=0").exit_code, 0);
  EXPECT_EQ(folder_.Read("frozen/trajectory.txt"),
            folder_.Read("plain/trajectory.txt"));
  EXPECT_FALSE(folder_.Has("plain/problems"));
  const std::vector<std::string> again = FrozenRun("again");
  ASSERT_EQ(files.size(), again.size());
  EXPECT_TRUE(folder_.Read("frozen/problems/000002_001.h5") ==
              folder_.Read("again/problems/000002_001.h5"));
}

TEST_F(SfSolve, OthersCanSolveTheFiles) {
  if (!HasProgram("solve_frozen")) GTEST_SKIP() << "solve_frozen is not built";
  Synthesize();
  for (const std::string& file : FrozenRun("run")) {
    const ProgramResult result = RunProgram("solve_frozen", file);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const std::size_t at = result.output.find("they differ by ");
    ASSERT_NE(at, std::string::npos) << result.output;
    EXPECT_LT(std::stod(result.output.substr(at + 15)), 1e-12);
    EXPECT_THAT(result.output, HasSubstr("CONVERGENCE"));
  }
}

TEST_F(SfSolve, SolvesTheProblemsOfTheExamples) {
  const std::string folder = RepositoryRoot() / "examples/problems/";
  std::string list;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".h5") list += entry.path().string() + " ";
  }
  const ProgramResult result =
      RunProgram("sf_solve", list +
                                 "--solvers=gn_pcg,"
                                 "ceres:sparse_normal_cholesky --output=" +
                                 (folder_ / "out"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("5 problems; their first costs"));
  const auto rows = Csv(folder_.Read("out/solvers.csv"));
  ASSERT_EQ(rows.size(), 1u + 5 * 2);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_THAT(rows[i][6], AnyOf("converged", "other_minimum")) << rows[i][0];
  }
  if (!HasProgram("solve_frozen")) GTEST_SKIP() << "solve_frozen is not built";
  EXPECT_EQ(RunProgram("solve_frozen", folder + "000005_001.h5").exit_code, 0);
}

TEST_F(SfSolve, ChecksTheDerivativesOfARun) {
  Synthesize();
  std::string list;
  for (const std::string& file : FrozenRun("run")) list += file + " ";
  const ProgramResult result =
      RunProgram("sf_solve", list + "--check_gradients");
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors;
  for (const char* term : {"point_to_plane", "projective_depth", "color",
                           "arap", "tracks", "temporal_arap"}) {
    EXPECT_THAT(result.output,
                HasSubstr(std::string(term) + ": derivatives deviate by "));
  }
}

TEST_F(SfSolve, SaysWhatIsWrong) {
  const std::string output = " --output=" + (folder_ / "out");
  ExpectRefused("sf_solve", output, "problems = none: expected files of");
  ExpectRefused("sf_solve", "none.h5" + output, "none.h5: not found");
  ExpectRefused("sf_solve", folder_.Write("a.h5", "text") + output,
                "a.h5: expected an HDF5 file");
  ExpectRefused("sf_solve", "a.h5", "--output = '': expected a folder");
  ExpectRefused("sf_solve", "a.h5 --solvers=ceres:best" + output,
                "'best' is no choice of a solver");
  ExpectRefused("sf_solve", "a.h5 --starts=hot" + output,
                "--starts = hot: expected warm, cold or both");
  ExpectRefused("sf_solve", "a.h5 --threads=0" + output,
                "--threads = 0: expected numbers 1..1024");
  ExpectRefused("sf_solve", "a.h5 a.h5" + output,
                "problems = a.h5: expected each once");
  ExpectRefused("sf_solve", "a.h5 --solvers=gn_pcg,gn_pcg:jacobi" + output,
                "--solvers = gn_pcg:jacobi: expected each once");
  ExpectRefused("sf_solve", "a.h5 --solvers=ceres:cgnr:dense_qr" + output,
                "expected one linear_solver for each solver");
  ExpectRefused("sf_solve", "a.h5 --repeat=0" + output,
                "--repeat = 0: expected >= 1");
  EXPECT_FALSE(folder_.Has("out"));
  ExpectRefused("sf_run", "--freeze=-1 --sequence=none" + output,
                "--freeze = -1: expected a number of frames, or 0");
}

}  // namespace
}  // namespace splitfusion
