// SIGINT to sf_run and to sf_batch: what was computed is kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr int kFrames = 60;

class Interruption : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program :
         {"sf_synth", "sf_run", "sf_evaluate", "sf_batch"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
    const ProgramResult result = RunProgram(
        "sf_synth", "--width=160 --height=120 --mesh_every=100 --frames=" +
                        std::to_string(kFrames) +
                        " --output=" + (folder_ / "sequence"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  int FramesIn(const std::string& run) const {
    const std::string begun = folder_.Read(run + "/unfinished/frames.jsonl");
    const std::string lines =
        begun.empty() ? folder_.Read(run + "/frames.jsonl") : begun;
    return static_cast<int>(std::count(lines.begin(), lines.end(), '\n'));
  }

  /// Sends one SIGINT to `program` when the run directory has two frames, and
  /// waits for its end.
  ProgramResult Interrupt(RunningProgram* program,
                          const std::string& run) const {
    while (program->Runs() && FramesIn(run) < 2) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program->Send(SIGINT);
    return program->Wait();
  }

  /// Sends two signals when the run directory has two frames, and waits for
  /// the end.
  ProgramResult InterruptTwice(RunningProgram* program, const std::string& run,
                               int first, int second, int pause_ms) const {
    while (program->Runs() && FramesIn(run) < 2) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    program->Send(first);
    std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
    program->Send(second);
    return program->Wait();
  }

  /// Of a batch over the sequence.
  std::string BatchArguments(const std::string& more) const {
    return "run --sequences=" + (folder_ / "sequence") +
           " --output=" + (folder_ / "out") + more;
  }

  /// Folder of the first task of such a batch.
  std::string FirstTask(const std::string& more) const {
    const std::string planned =
        RunProgram("sf_batch", BatchArguments(more) + " --dry_run").output;
    return "out/tasks/" + planned.substr(0, planned.find(' '));
  }

  /// Processes of sf_run whose command line names this run directory.
  std::vector<pid_t> AtWork(const std::string& run) const {
    std::vector<pid_t> processes;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream stream(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(stream), {}};
      const bool is_run = line.find("sf_run") != std::string::npos;
      if (is_run && line.find(folder_ / run) != std::string::npos) {
        processes.push_back(std::atoi(entry.path().filename().c_str()));
      }
    }
    return processes;
  }

  /// Expects a run directory that holds what was computed and says that it is
  /// not all.
  void ExpectUnfinished(const std::string& run) const {
    const Json summary = Json::parse(folder_.Read(run + "/summary.json"));
    EXPECT_EQ(summary["complete"], false);
    EXPECT_GE(summary["frames"], 2);
    EXPECT_LT(summary["frames"], kFrames);
    EXPECT_EQ(summary["frames"], FramesIn(run));
    EXPECT_TRUE(folder_.Has(run + "/report.html"));
    EXPECT_TRUE(folder_.Has(run + "/surfaces/000_background/mesh.ply"));
    EXPECT_TRUE(folder_.Has(run + "/surfaces/001_person/motions.bin"));
  }

  TemporaryFolder folder_;
};

TEST_F(Interruption, ARunWritesWhatItHas) {
  RunningProgram program("sf_run", "--sequence=" + (folder_ / "sequence") +
                                       " --output=" + (folder_ / "run"));
  const ProgramResult result = Interrupt(&program, "run");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("interrupted after "));
  EXPECT_THAT(result.errors, HasSubstr(" of 60 frames"));
  ExpectUnfinished("run");
}

TEST_F(Interruption, ASecondSignalOfAnyKindEndsARunAtOnce) {
  // A run that is quick enough ends by the first signal: it may try again.
  for (int attempt = 0; attempt < 8; ++attempt) {
    const std::string run = "run" + std::to_string(attempt);
    RunningProgram program("sf_run", "--sequence=" + (folder_ / "sequence") +
                                         " --output=" + (folder_ / run));
    const ProgramResult result =
        InterruptTwice(&program, run, SIGINT, SIGTERM, 0);
    if (result.exit_code == 1) continue;
    EXPECT_EQ(result.exit_code, -1);
    EXPECT_FALSE(folder_.Has(run + "/summary.json"));
    return;
  }
  ADD_FAILURE() << "every run ended by itself";
}

class TwoSignals : public Interruption,
                   public testing::WithParamInterface<std::pair<int, int>> {};

TEST_P(TwoSignals, EndABatchAndItsRun) {
  const auto [second, pause_ms] = GetParam();
  const std::string task = FirstTask("");
  RunningProgram program("sf_batch", BatchArguments(""));
  const std::string run = task + "/run";
  const ProgramResult result =
      InterruptTwice(&program, run, SIGINT, second, pause_ms);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("interrupted after 0 of 1 runs"));
  EXPECT_TRUE(AtWork(run).empty());
  EXPECT_THAT(folder_.Read("out/results.csv"), HasSubstr(",0,unfinished,"));
  // A run that is quick enough ends by the first signal.
  const Json record = Json::parse(folder_.Read(task + "/task.json"));
  const bool at_first = folder_.Has(run + "/summary.json");
  EXPECT_EQ(record["exit_code"], at_first ? 1 : 128 + SIGKILL);
}

INSTANTIATE_TEST_SUITE_P(OfAnyKind, TwoSignals,
                         testing::Values(std::pair(SIGINT, 1),
                                         std::pair(SIGTERM, 0),
                                         std::pair(SIGHUP, 5)));

TEST_F(Interruption, ABatchStopsItsRunAndGoesOnWithIt) {
  const std::string grid = " --grid=pictures_every=0,20";
  const std::string task = FirstTask(grid);
  RunningProgram program("sf_batch", BatchArguments(grid));
  const std::string run = task + "/run";
  const ProgramResult result = Interrupt(&program, run);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("interrupted after 0 of 2 runs"));
  ExpectUnfinished(run);
  const Json record = Json::parse(folder_.Read(task + "/task.json"));
  EXPECT_EQ(record["state"], "started");
  EXPECT_EQ(record["exit_code"], 1);
  EXPECT_THAT(record["last_lines"].back().get<std::string>(),
              HasSubstr("interrupted after "));
  EXPECT_THAT(folder_.Read("out/results.csv"), HasSubstr(",0,waiting,20,"));
  EXPECT_EQ(RunProgram("sf_batch", BatchArguments(grid)).exit_code, 0);
  const Json summary = Json::parse(folder_.Read(run + "/summary.json"));
  EXPECT_EQ(summary["frames"], kFrames);
  EXPECT_EQ(summary["resumed_at"].size(), 1u);
}

TEST_F(Interruption, ABatchThatIsSignalledWithAllItsProcessesSavesTheRun) {
  const std::string run = FirstTask("") + "/run";
  RunningProgram program("sf_batch", BatchArguments(""));
  while (program.Runs() && FramesIn(run) < 2) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  // As Slurm does at a time limit.
  for (const pid_t process : AtWork(run)) kill(process, SIGTERM);
  program.Send(SIGTERM);
  EXPECT_EQ(program.Wait().exit_code, 1);
  ExpectUnfinished(run);
}

}  // namespace
}  // namespace splitfusion
