// sf_batch as a program: killed and resumed, twice at once, with the real
// sf_run.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "support/program.h"
#include "support/repository.h"
#include "support/stub_programs.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

class SfBatch : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_batch")) GTEST_SKIP() << "sf_batch is not built";
    WriteScript(folder_, "bin/sf_run", kStubRun);
    WriteScript(folder_, "bin/sf_evaluate", kStubEvaluate);
  }

  void AddSequence(const std::string& name) const {
    folder_.Write("data/" + name + "/groundtruth.txt", "true");
  }

  /// Arguments that run the stubs over data/NAME into a folder.
  std::string Arguments(const std::string& names,
                        const std::string& output) const {
    std::string folders;
    std::istringstream stream(names);
    for (std::string name; std::getline(stream, name, ',');) {
      folders += (folders.empty() ? "" : ",") + (folder_ / ("data/" + name));
    }
    return "run --sequences=" + folders + " --output=" + (folder_ / output) +
           " --run_program=" + (folder_ / "bin/sf_run") +
           " --evaluate_program=" + (folder_ / "bin/sf_evaluate");
  }

  /// Waits until `done`, but not for ever.
  template <typename Condition>
  static bool WaitUntil(const Condition& done) {
    for (int i = 0; i < 2000; ++i) {
      if (done()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  TemporaryFolder folder_;
};

constexpr const char* kSweep =
    " --grid='x=1,2,3; terms.arap.weight=4,8' --repeat=2 --jobs=2 --threads=1";

TEST_F(SfBatch, ASweepThatIsKilledAndResumedHasTheSameTable) {
  for (const char* name : {"slow", "other_slow"}) AddSequence(name);
  const std::string undisturbed =
      Arguments("slow,other_slow", "undisturbed") + kSweep;
  ASSERT_EQ(RunProgram("sf_batch", undisturbed).exit_code, 0);
  const std::string killed = Arguments("slow,other_slow", "killed") + kSweep;
  for (const int milliseconds : {150, 420, 730}) {
    RunningProgram program("sf_batch", killed);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    program.Send(SIGKILL);
    program.Wait();
  }
  EXPECT_EQ(RunProgram("sf_batch", killed).exit_code, 0);
  const auto without_times = [&](const std::string& name) {
    std::istringstream lines(folder_.Read(name + "/results.csv"));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      for (int i = 0; i < 3; ++i) line.erase(line.rfind(','));
      text += line + "\n";
    }
    return text;
  };
  EXPECT_EQ(without_times("killed"), without_times("undisturbed"));
  const std::string table = without_times("killed");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 25);
}

TEST_F(SfBatch, TwoAtOnceMakeOneCompleteTable) {
  AddSequence("slow");
  const std::string arguments = Arguments("slow", "out") + kSweep;
  RunningProgram first("sf_batch", arguments);
  RunningProgram second("sf_batch", arguments);
  EXPECT_EQ(first.Wait().exit_code, 0);
  EXPECT_EQ(second.Wait().exit_code, 0);
  const std::string table = folder_.Read("out/results.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 13);
  const ProgramResult status =
      RunProgram("sf_batch", "status --output=" + (folder_ / "out"));
  EXPECT_EQ(status.output, "12 runs, 12 complete\n");
  // Each was computed once.
  const std::string starts = folder_.Read("data/slow/starts.txt");
  EXPECT_EQ(std::count(starts.begin(), starts.end(), '\n'), 12);
}

TEST_F(SfBatch, AChildDiesWithItsParent) {
  AddSequence("still");
  RunningProgram program("sf_batch", Arguments("still", "out"));
  const auto started = [&] {
    return !folder_.Read("data/still/starts.txt").empty();
  };
  ASSERT_TRUE(WaitUntil(started));
  const int child = std::stoi(folder_.Read("data/still/starts.txt"));
  const std::string process = "/proc/" + std::to_string(child) + "/cmdline";
  program.Send(SIGKILL);
  program.Wait();
  EXPECT_TRUE(WaitUntil([&] {
    std::ifstream stream(process);
    return (std::string{std::istreambuf_iterator<char>(stream), {}}).empty();
  }));
  EXPECT_THAT(
      RunProgram("sf_batch", "status --output=" + (folder_ / "out")).output,
      HasSubstr("1 unfinished"));
}

TEST_F(SfBatch, FailedRunsAreToldByExitCodeAndStatus) {
  for (const char* name : {"room", "bad"}) AddSequence(name);
  const ProgramResult result =
      RunProgram("sf_batch", Arguments("room,bad", "out"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("1 of 2 runs failed"));
  EXPECT_THAT(result.errors, HasSubstr("FAILED: bad/rgb.txt"));
  const std::string status =
      RunProgram("sf_batch", "status --output=" + (folder_ / "out")).output;
  EXPECT_THAT(status, HasSubstr("2 runs, 1 complete, 1 failed\nbad_"));
  EXPECT_THAT(status, HasSubstr("failed: bad/rgb.txt: cannot be opened"));
}

TEST_F(SfBatch, SaysWhatItExpects) {
  AddSequence("room");
  const ProgramResult none = RunProgram("sf_batch", "--output=x");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.errors, HasSubstr("expected run, status, collect"));
  const ProgramResult unknown =
      RunProgram("sf_batch", Arguments("room", "out") + " --grid='bogus=1,2'");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors, HasSubstr("bogus"));
  EXPECT_FALSE(folder_.Has("out"));
  EXPECT_EQ(
      RunProgram("sf_batch", "status --output=" + (folder_ / "none")).exit_code,
      2);
}

TEST_F(SfBatch, RefusesBeforeTheFirstRunWhatTheTablesWouldRefuse) {
  AddSequence("room");
  folder_.Write("file", "");
  const std::string arguments = Arguments("room", "out") + " --grid=x=1,2";
  const std::string folder = "--rows_csv=" + (folder_ / "data");
  for (const std::string& flag : std::vector<std::string>{
           "--baseline=x=3", "--baseline=none", "--foreign=a:hall=t.txt",
           "--foreign='a:room=t.txt; a:room=u.txt'", "--evaluate=nope=1",
           "--repeat=100000000", folder}) {
    for (const std::string dry : {"", " --dry_run"}) {
      const ProgramResult result =
          RunProgram("sf_batch", arguments + " " + flag + dry);
      EXPECT_EQ(result.exit_code, 2) << flag;
      EXPECT_FALSE(folder_.Has("out")) << flag;
    }
  }
  EXPECT_EQ(RunProgram("sf_batch",
                       arguments + " --rows_csv=" + (folder_ / "file/r.csv"))
                .exit_code,
            2);
  EXPECT_FALSE(folder_.Has("out"));
  const std::string file = folder_.Write("e.json", R"({"baseline": "x=3"})");
  EXPECT_THAT(
      RunProgram("sf_batch", arguments + " --experiment=" + file).errors,
      HasSubstr("e.json: baseline = x=3"));
  EXPECT_EQ(RunProgram("sf_batch", arguments + " --baseline=x=2").exit_code, 0);
  const std::string table = folder_.Read("out/results.csv");
  EXPECT_EQ(RunProgram("sf_batch",
                       "collect --baseline=none --output=" + (folder_ / "out"))
                .exit_code,
            2);
  EXPECT_EQ(folder_.Read("out/results.csv"), table);
}

TEST_F(SfBatch, CollectLeavesTablesOfOthers) {
  folder_.Write("out/tasks/notes.txt", "mine");
  folder_.Write("out/results.csv", "mine");
  const ProgramResult result =
      RunProgram("sf_batch", "collect --output=" + (folder_ / "out"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("holds no experiment"));
  EXPECT_EQ(folder_.Read("out/results.csv"), "mine");
}

TEST_F(SfBatch, CollectSaysThatRepeatsAreOutdated) {
  AddSequence("room");
  const std::string arguments = Arguments("room", "out") + " --set=flagfile=" +
                                folder_.Write("a.flags", "weight 4");
  ASSERT_EQ(RunProgram("sf_batch", arguments + " --repeat=4").exit_code, 0);
  folder_.Write("a.flags", "weight 64");
  ASSERT_EQ(RunProgram("sf_batch", arguments + " --repeat=2").exit_code, 0);
  const ProgramResult result =
      RunProgram("sf_batch", "collect --output=" + (folder_ / "out"));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("2 of 4 runs are outdated"));
  EXPECT_THAT(result.errors, HasSubstr("flags weight 4 -> weight 64"));
  EXPECT_THAT(folder_.Read("out/summary.csv"), HasSubstr("\nroom,2,4,"));
  EXPECT_THAT(
      RunProgram("sf_batch", "status --output=" + (folder_ / "out")).output,
      HasSubstr("4 runs, 2 complete, 2 outdated\n"));
}

TEST_F(SfBatch, SaysThatAFileOfRowsIsNew) {
  AddSequence("room");
  ASSERT_EQ(RunProgram("sf_batch", Arguments("room", "out")).exit_code, 0);
  const std::string collect = "collect --output=" + (folder_ / "out") +
                              " --rows_csv=" + (folder_ / "rows.csv");
  EXPECT_THAT(RunProgram("sf_batch", collect).errors,
              HasSubstr("rows.csv: is a new file"));
  EXPECT_EQ(RunProgram("sf_batch", collect).errors, "");
}

TEST_F(SfBatch, ADryRunPrintsTheTasks) {
  AddSequence("room");
  const ProgramResult result = RunProgram(
      "sf_batch", Arguments("room", "out") + " --repeat=2 --dry_run");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("_r1  new\n2 new\n"));
  EXPECT_FALSE(folder_.Has("out"));
}

TEST_F(SfBatch, TakesTheExperimentsOfTheToolkit) {
  const auto tools = RepositoryRoot() / "tools";
  if (!std::filesystem::exists(tools / "ablation.json") ||
      !HasProgram("sf_run") || !HasProgram("sf_synth")) {
    GTEST_SKIP() << "not built in the repository, or without its programs";
  }
  RunProgram("sf_synth", "--width=160 --height=120 --frames=2 --output=" +
                             (folder_ / "sequence"));
  for (const char* file : {"ablation.json", "terms.json"}) {
    const ProgramResult result = RunProgram(
        "sf_batch", "run --experiment=" + (tools / file).string() +
                        " --sequences=" + (folder_ / "sequence") +
                        " --output=" + (folder_ / "out") + " --dry_run");
    EXPECT_EQ(result.exit_code, 0) << file << result.errors;
    EXPECT_THAT(result.output, HasSubstr(" new\n")) << file;
  }
}

TEST_F(SfBatch, AnAblationComparesItsRowsAndKeepsThem) {
  for (const char* name : {"room", "desk"}) AddSequence(name);
  const std::string file = folder_.Write("ablation.json", R"({
    "repeat": 2, "baseline": "all",
    "rows": [{"name": "all"}, {"name": "no_bend", "set": {"bend": 0}},
             {"name": "other", "set": {"other": 1}}]})");
  const std::string arguments =
      Arguments("room,desk", "out") + " --experiment=" + file +
      " --rows=all,no_bend --rows_csv=" + (folder_ / "rows.csv");
  const ProgramResult result = RunProgram("sf_batch", arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Differences to all"));
  EXPECT_THAT(result.output, HasSubstr("(all)     no_bend"));
  std::filesystem::remove_all(folder_ / "out");
  const std::string starts = folder_.Read("data/room/starts.txt");
  EXPECT_EQ(RunProgram("sf_batch", arguments).output, result.output);
  EXPECT_EQ(folder_.Read("data/room/starts.txt"), starts);
}

TEST_F(SfBatch, EmitsArraysOfWhatIsNotFinished) {
  for (const char* name : {"room", "bad"}) AddSequence(name);
  std::string arguments = Arguments("room,bad", "out");
  arguments.replace(0, 3, "emit-slurm");
  const ProgramResult emitted = RunProgram("sf_batch", arguments);
  EXPECT_EQ(emitted.exit_code, 0) << emitted.errors;
  EXPECT_THAT(emitted.output, HasSubstr("\nsubmit 1 2 \"$@\"\n"));
  EXPECT_THAT(emitted.output,
              HasSubstr("'--run_program=" + (folder_ / "bin/sf_run") + "'"));
  const std::string output = " --output=" + (folder_ / "out");
  EXPECT_EQ(RunProgram("sf_batch", "status" + output).output,
            "2 runs, 2 waiting\n");
  const std::string list =
      std::filesystem::directory_iterator(folder_ / "out/slurm")
          ->path()
          .string();
  const std::string run =
      "run" + output + " --run_program=" + (folder_ / "bin/sf_run") +
      " --evaluate_program=" + (folder_ / "bin/sf_evaluate") +
      " --task_list=" + list;
  EXPECT_EQ(RunProgram("sf_batch", run + " --task=1").exit_code, 0);
  EXPECT_EQ(RunProgram("sf_batch", run + " --task=2").exit_code, 3);
  EXPECT_FALSE(folder_.Has("out/results.csv"));
  EXPECT_THAT(RunProgram("sf_batch", "status" + output).output,
              HasSubstr("2 runs, 1 complete, 1 failed\nbad_"));
  const std::string again =
      "emit-slurm" + output + " --run_program=" + (folder_ / "bin/sf_run") +
      " --evaluate_program=" + (folder_ / "bin/sf_evaluate");
  EXPECT_THAT(RunProgram("sf_batch", again).output,
              HasSubstr("\nsubmit 1 1 \"$@\"\n"));
  const ProgramResult rest = RunProgram("sf_batch", again + " --keep_failed");
  EXPECT_EQ(rest.exit_code, 0);
  EXPECT_EQ(rest.errors, "sf_batch: all runs are finished\n");
}

TEST_F(SfBatch, SaysWhatArraysCannotTake) {
  AddSequence("room");
  std::string arguments = Arguments("room", "out");
  arguments.replace(0, 3, "emit-slurm");
  const std::vector<std::pair<std::string, std::string>> refused = {
      {arguments + " --slurm_max_array=0", "--slurm_max_array = 0: expected"},
      {arguments + " --jobs=3", "--jobs = 3: expected no such flag"},
      {arguments + " --grid=bogus=1", "bogus"},
      {"emit-slurm --output=" + (folder_ / "none"), "holds no experiment"},
      {Arguments("room", "out") + " --task=3", "--task = 3: expected"},
      {Arguments("room", "out") + " --task_list=x --task=3", "--sequences = "},
      {"run --task=1 --task_list=none --output=" + (folder_ / "out"),
       "none: cannot be opened"}};
  for (const auto& [command, message] : refused) {
    const ProgramResult result = RunProgram("sf_batch", command);
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.errors, HasSubstr(message));
  }
  EXPECT_FALSE(folder_.Has("out"));
}

TEST_F(SfBatch, HelpFitsAScreen) {
  const std::string help = RunProgram("sf_batch", "--help").output;
  EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 40);
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 80u) << line;
  }
}

TEST_F(SfBatch, SweepsTheRealProgram) {
  for (const char* name : {"sf_synth", "sf_run", "sf_evaluate"}) {
    if (!HasProgram(name)) GTEST_SKIP() << name << " is not built";
  }
  ASSERT_EQ(RunProgram("sf_synth",
                       "--width=160 --height=120 --frames=4 "
                       "--output=" +
                           (folder_ / "sequence"))
                .exit_code,
            0);
  const std::string arguments =
      "run --sequences=" + (folder_ / "sequence") +
      " --output=" + (folder_ / "out") +
      " --grid='terms.arap.weight=4,8' --repeat=2 --set=pictures_every=0"
      " --baseline=terms.arap.weight=4";
  const ProgramResult result = RunProgram("sf_batch", arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("Differences to terms.arap.weight=4"));
  const std::string csv = folder_.Read("out/results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, HasSubstr(",sequence,1,complete,8,4,0,0."));
  EXPECT_TRUE(folder_.Has("out/differences.csv"));
  EXPECT_TRUE(folder_.Has("out/effects.csv"));
  EXPECT_TRUE(folder_.Has("out/results.sqlite"));
  const ProgramResult again = RunProgram("sf_batch", arguments);
  EXPECT_THAT(again.errors, HasSubstr(" kept"));
  EXPECT_EQ(folder_.Read("out/results.csv"), csv);
  const ProgramResult other =
      RunProgram("sf_batch", "run --sequences=" + (folder_ / "sequence") +
                                 " --output=" + (folder_ / "none") +
                                 " --grid=terms.arap.wieght=4,8");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("wieght"));
  const std::filesystem::path task =
      std::filesystem::directory_iterator(folder_ / "out/tasks")->path();
  std::filesystem::remove(task / "run/evaluation.json");
  RunProgram("sf_batch", arguments);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("kept, evaluated again: evaluation.json: missing"));
  EXPECT_EQ(folder_.Read("out/results.csv"), csv);
  std::filesystem::resize_file(task / "run/trajectory.txt", 10);
  EXPECT_THAT(
      RunProgram("sf_batch", "status --output=" + (folder_ / "out")).output,
      HasSubstr("damaged: trajectory.txt was changed"));
  for (const std::string option :
       {"pictures_every", "warped_every", "threads", "checkpoint_every"}) {
    const ProgramResult refused =
        RunProgram("sf_batch", "run --sequences=" + (folder_ / "sequence") +
                                   " --output=" + (folder_ / "none") +
                                   " --set=" + option + "=-7");
    EXPECT_EQ(refused.exit_code, 2) << option;
    EXPECT_THAT(refused.errors, HasSubstr(option));
  }
  EXPECT_FALSE(folder_.Has("none"));
}

}  // namespace
}  // namespace splitfusion
