// The program sf_refine, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>

#include "sf_run_fixture.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "support/expect_refused.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

class SfRefine : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (!HasProgram("sf_refine")) GTEST_SKIP() << "sf_refine is not built";
  }

  ProgramResult Refine(const std::string& output,
                       const std::string& arguments = "") const {
    return RunProgram("sf_refine", (folder_ / "run") + " --output=" +
                                       (folder_ / output) + " " + arguments);
  }

  void MakeRun(const std::string& arguments = "") const {
    Synthesize("--frames=12");
    const ProgramResult result =
        Run("run", "--pictures_every=0 --warped_every=4 " + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  MotionHistory Motions(const std::string& run) const {
    return ReadMotions(folder_ / (run + "/surfaces/001_person/motions.bin"));
  }

  /// Motions of nodes that differ between two runs: of nodes that were seen,
  /// and of others.
  std::pair<int, int> Differences(const std::string& a,
                                  const std::string& b) const {
    const MotionHistory one = Motions(a), other = Motions(b);
    std::pair<int, int> count;
    EXPECT_EQ(one.size(), other.size());
    for (int f = 0; f < one.size(); ++f) {
      const std::vector<NodeMotion> motions = one.At(f).motions;
      const std::vector<NodeMotion> others = other.At(f).motions;
      const std::vector<char> seen = one.At(f).seen;
      for (std::size_t i = 0; i < motions.size(); ++i) {
        if (motions[i].translation == others[i].translation) continue;
        ++(seen[i] != 0 ? count.first : count.second);
      }
    }
    return count;
  }
};

TEST_F(SfRefine, FindsHiddenMotionsOfAFinishedRun) {
  MakeRun("--refine=false");
  EXPECT_FALSE(folder_.Has("run/refinement.jsonl"));
  const ProgramResult result = Refine("refined");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("motions of hidden nodes"));
  const auto [seen, hidden] = Differences("run", "refined");
  EXPECT_EQ(seen, 0);
  EXPECT_GT(hidden, 0);
  int counted = 0;
  std::istringstream lines(folder_.Read("refined/refinement.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const auto window = nlohmann::json::parse(line);
    EXPECT_TRUE(window["solved"].get<bool>());
    counted += window["kept"].get<int>();
  }
  EXPECT_GE(counted, hidden);
  EXPECT_THAT(result.output, HasSubstr(std::to_string(counted) + " motions"));
  const auto summary =
      nlohmann::json::parse(folder_.Read("refined/summary.json"));
  const auto before = nlohmann::json::parse(folder_.Read("run/summary.json"));
  EXPECT_NEAR(summary["seconds_per_frame_all_passes"].get<double>(),
              before["seconds_per_frame_all_passes"].get<double>() +
                  (summary["seconds_refining"].get<double>() -
                   before["seconds_refining"].get<double>()) /
                      12,
              1e-9);
  EXPECT_EQ(folder_.Read("refined/trajectory.txt"),
            folder_.Read("run/trajectory.txt"));
  EXPECT_EQ(folder_.Read("refined/surfaces/001_person/mesh.ply"),
            folder_.Read("run/surfaces/001_person/mesh.ply"));
  EXPECT_TRUE(folder_.Has("refined/surfaces/001_person/warped/000008.ply"));
  EXPECT_TRUE(folder_.Has("refined/report.html"));
  EXPECT_THAT(folder_.Read("refined/options.flags"),
              HasSubstr("--refine=true\n"));
  EXPECT_EQ(
      RunProgram("sf_evaluate", "--run=" + (folder_ / "refined")).exit_code, 0);
}

TEST_F(SfRefine, EstimatesHowWellHiddenMotionsAreKnown) {
  MakeRun();
  EXPECT_FALSE(folder_.Has("run/hidden_deviations.csv"));
  ASSERT_EQ(Refine("refined", "--refine_samples=2").exit_code, 0);
  std::istringstream rows(folder_.Read("refined/hidden_deviations.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "surface,frame,node,sigma");
  const MotionHistory motions = Motions("refined");
  int count = 0;
  while (std::getline(rows, row)) {
    int surface = 0, frame = 0, node = 0;
    double sigma = 0;
    ASSERT_EQ(std::sscanf(row.c_str(), "%d,%d,%d,%lf", &surface, &frame, &node,
                          &sigma),
              4)
        << row;
    EXPECT_EQ(surface, 1);
    EXPECT_FALSE(motions.Find(frame)->Saw(node));
    EXPECT_GT(sigma, 0);
    EXPECT_LT(sigma, 0.5);
    ++count;
  }
  int hidden = 0;
  std::istringstream lines(folder_.Read("refined/refinement.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    hidden += nlohmann::json::parse(line)["kept"].get<int>();
  }
  EXPECT_EQ(count, hidden);
  EXPECT_THAT(folder_.Read("refined/options.flags"),
              HasSubstr("--refine_samples=2\n"));
}

TEST_F(SfRefine, FreezesItsWindowsForOtherSolvers) {
  MakeRun();
  const ProgramResult result = Refine("refined", "--freeze=1");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  int windows = 0;
  std::istringstream lines(folder_.Read("refined/refinement.jsonl"));
  for (std::string line; std::getline(lines, line); ++windows) {
    EXPECT_TRUE(folder_.Has("refined/problems/000000_001_hidden_0.h5"));
  }
  ASSERT_GT(windows, 0);
  const ProgramResult solved = RunProgram(
      "sf_solve",
      (folder_ / "refined/problems/000000_001_hidden_0.h5") +
          " --solvers=gn_cholesky,ceres --output=" + (folder_ / "solved"));
  ASSERT_EQ(solved.exit_code, 0) << solved.errors;
  EXPECT_THAT(solved.output, HasSubstr("gn_cholesky: 1 converged"));
  EXPECT_THAT(solved.output, HasSubstr("ceres: 1 converged"));
  // They are of that refinement alone; all else goes with the run.
  const std::string again = (folder_ / "refined") +
                            " --output=" + (folder_ / "again") + " --overwrite";
  ASSERT_EQ(RunProgram("sf_refine", again + " --freeze=1").exit_code, 0);
  EXPECT_TRUE(folder_.Has("again/problems/000000_001_hidden_0.h5"));
  ASSERT_EQ(RunProgram("sf_refine", again).exit_code, 0);
  EXPECT_FALSE(folder_.Has("again/problems/000000_001_hidden_0.h5"));
  ExpectRefused(
      "sf_refine",
      (folder_ / "run") + " --freeze=-1 --output=" + (folder_ / "other"),
      "freeze = -1: expected >= 0");
}

TEST_F(SfRefine, IsWhatTheRunItselfWouldHaveDone) {
  MakeRun("--refine=false");
  const ProgramResult whole =
      Run("whole", "--pictures_every=0 --warped_every=4");
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  ASSERT_EQ(Refine("refined").exit_code, 0);
  const MotionHistory a = Motions("whole"), b = Motions("refined");
  double farthest = 0;
  for (int f = 0; f < a.size(); ++f) {
    const std::vector<NodeMotion> one = a.At(f).motions;
    const std::vector<NodeMotion> other = b.At(f).motions;
    for (std::size_t i = 0; i < one.size(); ++i) {
      farthest = std::max(farthest,
                          (one[i].translation - other[i].translation).norm());
    }
  }
  EXPECT_LT(farthest, 1e-4) << "the run's files hold floats and six decimals";
}

TEST_F(SfRefine, TakesOtherWeightsAndIsDoneOnce) {
  MakeRun();
  ASSERT_EQ(Refine("soft", "--refine_smoothness=0.1 --threads=1").exit_code, 0);
  EXPECT_GT(Differences("run", "soft").second, 0);
  EXPECT_THAT(folder_.Read("soft/options.flags"),
              HasSubstr("--refine_smoothness=0.1\n"));
  EXPECT_THAT(Refine("soft", "--refine_smoothness=0.1").output,
              HasSubstr("nothing to do"));
  EXPECT_NE(Refine("soft").exit_code, 0) << "of other options";
  EXPECT_EQ(Refine("soft", "--overwrite").exit_code, 0);
  ASSERT_EQ(Refine("threads", "--threads=2").exit_code, 0);
  EXPECT_EQ(folder_.Read("soft/surfaces/001_person/motions.bin"),
            folder_.Read("threads/surfaces/001_person/motions.bin"));
}

TEST_F(SfRefine, SaysWhatIsWrong) {
  const std::string output = " --output=" + (folder_ / "out");
  ExpectRefused("sf_refine", output, "RUN = 0: expected one run directory");
  ExpectRefused("sf_refine", folder_ / "none",
                "--output = '': expected a folder to write");
  ExpectRefused("sf_refine", (folder_ / "none") + output,
                "holds no complete run");
  ExpectRefused("sf_refine",
                (folder_ / "none") + output + " --refine_smoothness=0",
                "--refine_smoothness = 0: expected 0..1e+06, not 0");
  ExpectRefused("sf_refine", (folder_ / "none") + output + " --refine_window=2",
                "--refine_window = 2: expected frames >= 4");
  ExpectRefused("sf_refine",
                (folder_ / "none") + output + " --refine_samples=10001",
                "--refine_samples = 10001: expected 0..10000");
  MakeRun();
  const std::string motions = "run/surfaces/001_person/motions.bin";
  const std::string bytes = folder_.Read(motions);
  folder_.Write(motions, std::string(bytes.size(), 'x'));
  EXPECT_THAT(Refine("out").errors, HasSubstr("motions.bin"));
  EXPECT_FALSE(folder_.Has("out/run.json"));
  folder_.Write(motions, bytes);
  EXPECT_EQ(Refine("out").exit_code, 0);
}

TEST_F(SfRefine, LeavesTheRunThatItReadsAlone) {
  MakeRun();
  const std::string marker = folder_.Read("run/run.json");
  std::filesystem::create_directory_symlink(folder_ / "run", folder_ / "link");
  for (const char* output : {"run", "link", "run/surfaces/.."}) {
    ExpectRefused(
        "sf_refine",
        (folder_ / "run") + " --overwrite --output=" + (folder_ / output),
        "expected a folder outside of --output");
  }
  ExpectRefused("sf_refine",
                (folder_ / "run") + " --output=" + (folder_ / "run/new"),
                "expected a folder outside of RUN");
  EXPECT_EQ(folder_.Read("run/run.json"), marker);
  EXPECT_FALSE(folder_.Has("run/new"));
}

}  // namespace
}  // namespace splitfusion
