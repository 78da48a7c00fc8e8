#include "splitfusion/lib/experiment/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>

#include "experiment/sweep_fixture.h"
#include "splitfusion/lib/base/directory_lock.h"
#include "splitfusion/lib/experiment/repeats.h"
#include "splitfusion/lib/report/run_marker.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(SweepTest, RunsAndEvaluatesEveryTask) {
  AddSequence("room", "true");
  AddSequence("desk");
  experiment_.grid = ParseGrid("terms.arap.weight=4,8", "grid");
  options_.jobs = 2;
  EXPECT_EQ(Sweep().failed, 0);
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.keys, std::vector<std::string>{"terms.arap.weight"});
  EXPECT_EQ(table.rows[1].values[0], "8");
  EXPECT_EQ(table.rows[3].task.sequence, "desk");
  for (const ResultRow& row : table.rows) {
    EXPECT_EQ(row.status, "complete");
    EXPECT_EQ(row.figures.At("frames"), 10);
    EXPECT_EQ(row.figures.At("seconds_per_frame"), 0.5);
    const bool has_truth = row.task.sequence == "room";
    EXPECT_EQ(std::isfinite(row.figures.At("ate_m")), has_truth);
    EXPECT_TRUE(std::isnan(row.figures.At("rpe_m")));  // null.
  }
  EXPECT_NE(table.rows[0].figures.At("ate_m"),
            table.rows[1].figures.At("ate_m"));
  EXPECT_THAT(folder_.Read(InRun(0, "run.json")),
              HasSubstr("terms.arap.weight=4"));
}

TEST_F(SweepTest, OptionsOfAClassAreSetAsThoseOfAll) {
  AddSequence("room");
  experiment_.grid = ParseGrid("person.terms.arap.weight=4,8", "grid");
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_THAT(folder_.Read(InRun(1, "run.json")),
              HasSubstr("\"set\": \"person.terms.arap.weight=8\""));
}

TEST_F(SweepTest, FinishedRunsAndTheirEvaluationsAreKept) {
  AddSequence("room", "true");
  Sweep();
  Sweep();
  EXPECT_EQ(Starts("room"), 1);
  EXPECT_EQ(Lines("data/room/evaluations.txt"), 1);
  ListFiles(0);
  fs::remove(folder_ / InRun(0, "evaluation.json"));
  EXPECT_EQ(DryRun(experiment_, options_)[0].second,
            "to be evaluated: evaluation.json: missing");
  Sweep();
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("kept, evaluated again: evaluation.json: missing"));
  EXPECT_EQ(Starts("room"), 1);
  EXPECT_EQ(Lines("data/room/evaluations.txt"), 2);
  options_.runner.overwrite = true;
  Sweep();
  EXPECT_EQ(Starts("room"), 2);
}

TEST_F(SweepTest, AnEditedFlagfileIsRunAgainWithTheReason) {
  AddSequence("room", "true");
  const std::string file = folder_.Write("a.flags", "--lambda=5");
  experiment_.set.Set("flagfile", file);
  Sweep();
  const double before = Table().rows[0].figures.At("ate_m");
  folder_.Write("a.flags", "--lambda=9");
  EXPECT_EQ(DryRun(experiment_, options_)[0].second,
            "changed: flags --lambda=5 -> --lambda=9");
  Sweep();
  EXPECT_EQ(Starts("room"), 2);
  ASSERT_EQ(Table().rows.size(), 1u);
  EXPECT_EQ(Table().rows[0].status, "complete");
  EXPECT_NE(Table().rows[0].figures.At("ate_m"), before);
  EXPECT_EQ(Lines("data/room/evaluations.txt"), 2);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("again: flags --lambda=5 -> --lambda=9"));
}

TEST_F(SweepTest, ASubsetRunLaterLeavesAllRows) {
  AddSequence("room", "true");
  AddSequence("desk", "true");
  experiment_.grid = ParseGrid("x=1,2", "grid");
  Sweep();
  experiment_.sequences.pop_back();
  experiment_.grid = ParseGrid("x=2; y=5", "grid");
  Sweep();
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 5u);
  EXPECT_EQ(table.keys, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(table.rows[1].values, (std::vector<std::string>{"2", ""}));
  EXPECT_EQ(table.rows[4].values, (std::vector<std::string>{"2", "5"}));
  for (const ResultRow& row : table.rows) EXPECT_EQ(row.status, "complete");
}

TEST_F(SweepTest, OtherCommonOptionsBecomeAColumn) {
  AddSequence("room");
  experiment_.set.Set("max_frames", "3");
  Sweep();
  experiment_.set.Set("max_frames", "4");
  Sweep();
  EXPECT_EQ(Table().keys, std::vector<std::string>{"max_frames"});
  EXPECT_EQ(Table().rows[1].values[0], "4");
}

TEST_F(SweepTest, AFailedRunStaysFailedWhenRepeated) {
  AddSequence("bad", "true");
  AddSequence("crash");
  AddSequence("room");
  for (int i = 1; i <= 2; ++i) {
    const SweepOutcome outcome = Sweep();
    EXPECT_EQ(outcome.ended, 3);
    EXPECT_EQ(outcome.failed, 2);
    EXPECT_EQ(Starts("bad"), i);
    const ResultTable table = Table();
    EXPECT_EQ(table.rows[0].status, "failed");
    EXPECT_EQ(table.rows[0].error, "bad/rgb.txt: cannot be opened");
    EXPECT_TRUE(std::isnan(table.rows[0].figures.At("frames")));
    EXPECT_EQ(table.rows[1].error, "ended by signal 11");
    EXPECT_EQ(table.rows[2].status, "complete");
  }
  options_.runner.keep_failed = true;
  EXPECT_EQ(Sweep().failed, 2);
  EXPECT_EQ(Starts("bad"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "data/bad/evaluations.txt"));
}

TEST_F(SweepTest, ARunThatFailsAfterAnOlderResultShowsNoFigures) {
  AddSequence("room", "true");
  Sweep();
  const std::string good = WriteScript(folder_, "bin/good", kStubRun);
  WriteScript(folder_, "bin/sf_run",
              "#!/bin/sh\ncase \"$*\" in *overwrite*) exit 1 ;; esac\nexec '" +
                  good + "' \"$@\"\n");
  EXPECT_EQ(Sweep().failed, 1);
  EXPECT_EQ(Table().rows[0].status, "failed");
  EXPECT_TRUE(std::isnan(Table().rows[0].figures.At("ate_m")));
}

TEST_F(SweepTest, ARunThatCannotBeJudgedSaysSo) {
  AddSequence("room", "broken");
  EXPECT_EQ(Sweep().failed, 1);
  EXPECT_EQ(Table().rows[0].status, "not evaluated");
  EXPECT_EQ(Table().rows[0].error, "no pose");
  folder_.Write("data/room/groundtruth.txt", "true");
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_EQ(Starts("room"), 1);
  EXPECT_EQ(Table().rows[0].status, "complete");
}

TEST_F(SweepTest, ADamagedMarkerIsSetAsideAndTheRunDoneAgain) {
  AddSequence("room");
  Sweep();
  // As sf_run, which takes no folder with a damaged marker.
  const std::string good = WriteScript(folder_, "bin/good", kStubRun);
  WriteScript(folder_, "bin/sf_run",
              "#!/bin/sh\ncase \"$*\" in *print_identity*) ;; *) [ -e " +
                  (folder_ / InRun(0, "number.txt")) +
                  " ] && exit 2 ;; esac\nexec '" + good + "' \"$@\"\n");
  const std::string run = InRun(0, "run.json");
  for (const bool missing : {false, true}) {
    folder_.Write(run, "{");
    if (missing) fs::remove(folder_ / run);
    EXPECT_EQ(Sweep().failed, 0);
    EXPECT_EQ(Table().rows[0].status, "complete");
  }
  EXPECT_EQ(Starts("room"), 3);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("is damaged: expected the marker of a run"));
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("; it is now run.before-"));
}

TEST_F(SweepTest, MoreThanAMillionRunsAreRefused) {
  AddSequence("room");
  experiment_.repeat = 100000000;
  ExpectInputError([&] { DryRun(experiment_, options_); },
                   "at most 1000000 runs");
}

TEST_F(SweepTest, UnknownKeysAreRefusedBeforeAnythingRuns) {
  AddSequence("room");
  experiment_.grid = ParseGrid("x=1,2; bogus=1", "grid");
  ExpectInputError([&] { Sweep(); },
                   "options \"x=1; bogus=1\": stub: unknown flag bogus");
  EXPECT_EQ(Starts("room"), 0);
  EXPECT_FALSE(folder_.Has("out"));
}

TEST_F(SweepTest, QuotedValuesReachTheRunAsTheyAre) {
  AddSequence("room");
  experiment_.grid =
      ParseGrid(R"t(terms="a(b=1,c=2) d(e=""3"");","f g")t", "grid");
  Sweep();
  EXPECT_EQ(Table().rows[0].values[0], R"t(a(b=1,c=2) d(e="3");)t");
  EXPECT_THAT(folder_.Read(InRun(0, "run.json")),
              HasSubstr(R"t("terms": "a(b=1,c=2) d(e=\"3\");")t"));
}

TEST_F(SweepTest, RepeatsMoveTheVoxelsByMillionths) {
  AddSequence("room");
  experiment_.set.Set("object_voxel", "0.004");
  experiment_.repeat = 4;
  Sweep();
  std::set<double> sizes;
  for (const ResultRow& row : Table().rows) {
    const std::string run = "out/tasks/" + row.task.name + "/run";
    const NamedValues parts = ReadRunMarker(folder_ / run)->identity.parts;
    for (const auto& [key, size] : {std::pair("object_voxel", 0.004),
                                    std::pair("background_voxel", 0.01)}) {
      const double moved = std::abs(std::stod(parts.at(key)) / size - 1);
      EXPECT_LE(moved, 1e-5) << key;
      EXPECT_EQ(moved > 0.9e-6, row.task.repeat > 0) << key;
    }
    sizes.insert(std::stod(parts.at("object_voxel")));
  }
  EXPECT_EQ(sizes.size(), 4u);
  EXPECT_TRUE(Table().keys.empty());
  const auto again =
      ShiftVoxels({{"object_voxel", "0.004"}, {"background_voxel", "0.01"}}, 2);
  EXPECT_EQ(sizes.count(std::stod(*again.Find("object_voxel"))), 1u);
}

TEST_F(SweepTest, WhatWasNotMeasuredFromTheFirstFrameIsUnknown) {
  AddSequence("resumed");
  AddSequence("room");
  Sweep();
  const ResultTable table = Table();
  EXPECT_TRUE(std::isnan(table.rows[0].cost.wall_seconds));
  EXPECT_TRUE(std::isnan(table.rows[0].figures.At("peak_memory_bytes")));
  EXPECT_GT(table.rows[1].cost.wall_seconds, 0);
  EXPECT_GT(table.rows[1].figures.At("cpu_seconds_per_frame"), 0);
  EXPECT_THAT(folder_.Read(InRun(0, "../task.json")),
              HasSubstr("\"wall_seconds\": null"));
  // A run that ended after its sf_batch was killed.
  const std::string record = InRun(1, "../task.json");
  std::string text = folder_.Read(record);
  text.replace(text.find("\"run_id\": \"") + 11, 3, "");
  folder_.Write(record, text);
  Sweep();
  EXPECT_EQ(Starts("room"), 1);
  EXPECT_TRUE(std::isnan(Table().rows[1].cost.wall_seconds));
}

TEST_F(SweepTest, AFailureWithoutAWordHasAReason) {
  AddSequence("mute");
  EXPECT_EQ(Sweep().failed, 1);
  EXPECT_EQ(Table().rows[0].error, "exit code 4, without a word");
}

TEST_F(SweepTest, FlagsOfTheEvaluationAreCheckedBeforeAnythingRuns) {
  AddSequence("room", "true");
  experiment_.evaluate.Set("nope", "1");
  ExpectInputError([&] { Sweep(); },
                   "evaluate \"nope=1\": stub: unknown flag nope");
  ExpectInputError([&] { DryRun(experiment_, options_); }, "nope");
  EXPECT_EQ(Starts("room"), 0);
}

TEST_F(SweepTest, LimitsEndARunThatIsRecorded) {
  AddSequence("still");
  options_.runner.limits.wall_seconds = 0.2;
  EXPECT_EQ(Sweep().failed, 1);
  EXPECT_EQ(Table().rows[0].status, "failed");
  EXPECT_THAT(Table().rows[0].error, HasSubstr("killed: over the limit of"));
}

TEST_F(SweepTest, FailFastStartsNothingAfterAFailure) {
  for (const char* name : {"room", "bad", "desk"}) AddSequence(name);
  options_.fail_fast = true;
  const SweepOutcome outcome = Sweep();
  EXPECT_EQ(outcome.ended, 2);
  EXPECT_EQ(outcome.failed, 1);
  EXPECT_EQ(Table().rows[2].status, "waiting");
}

TEST_F(SweepTest, WaitsForTheLockOfARunWhoseComputerHasDied) {
  AddSequence("room");
  AddExperiment(ExperimentFolder(folder_.Make("out")), experiment_);
  const std::string run =
      "out/tasks/" + PlanTasks(experiment_)[0].name + "/run";
  const std::string lock =
      folder_.Write(run + "/lock", R"({"id": "1", "host": "gone", "boot": "1",
                                       "pid": 1, "process_start": 1})");
  // Two seconds before it counts as silent.
  fs::last_write_time(lock, fs::file_time_type::clock::now() -
                                LockOptions().silence +
                                std::chrono::seconds(2));
  ASSERT_TRUE(LivingHolder(lock));
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_FALSE(LivingHolder(lock));
}

TEST_F(SweepTest, ADryRunChangesNothing) {
  AddSequence("room");
  AddSequence("bad");
  EXPECT_EQ(DryRun(experiment_, options_)[0].second, "new");
  EXPECT_FALSE(folder_.Has("out"));
  Sweep();
  AddSequence("desk");
  const auto planned = DryRun(experiment_, options_);
  EXPECT_EQ(planned[0].second, "finished");
  EXPECT_EQ(planned[1].second, "failed: bad/rgb.txt: cannot be opened");
  EXPECT_EQ(planned[2].second, "new");
  EXPECT_EQ(Table().rows.size(), 2u);
  EXPECT_EQ(Starts("room"), 1);
}

TEST_F(SweepTest, StopsTheRunningChildAndGoesOnLater) {
  for (const char* name : {"room", "endless", "desk"}) AddSequence(name);
  const SweepOutcome outcome = RunSweep(experiment_, options_, {}, [&] {
    const auto rows = folder_.Has("out/tasks") ? Table().rows.size() : 0;
    const bool on = rows > 1 && folder_.Has(InRun(1, "started"));
    return on ? Stop::kWhenReady : Stop::kNo;
  });
  EXPECT_EQ(outcome.ended, 1);
  EXPECT_EQ(outcome.failed, 0);
  EXPECT_EQ(Table().rows[0].status, "complete");
  EXPECT_EQ(Table().rows[1].status, "unfinished");
  EXPECT_EQ(Table().rows[2].status, "waiting");
}

TEST_F(SweepTest, ThreadsCountWhereTheyAreSwept) {
  AddSequence("room");
  experiment_.grid = ParseGrid("threads=1,2", "grid");
  EXPECT_EQ(Sweep().ended, 2);
  EXPECT_EQ(Table().rows.size(), 2u);
  EXPECT_EQ(Table().keys, std::vector<std::string>{"threads"});
}

TEST_F(SweepTest, AnotherProgramIsASetting) {
  AddSequence("room");
  const std::string other = WriteScript(
      folder_, "bin/other",
      "#!/bin/sh\nexec '" + options_.run_program + "' --version=2 \"$@\"\n");
  experiment_.grid = {{"run_program", {options_.run_program, other}}};
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_THAT(folder_.Read(InRun(1, "run.json")), HasSubstr("version"));
}

TEST_F(SweepTest, ANameThatStandsForAnotherFolderIsRefused) {
  AddSequence("room");
  Sweep();
  folder_.Write("other/room/rgb.txt", "");
  experiment_.sequences = ReadSequences(folder_ / "other/room", "auto");
  ExpectInputError([&] { Sweep(); }, "another name");
  EXPECT_EQ(Table().rows[0].status, "complete");
}

TEST_F(SweepTest, RowsOfAFileCountAsDone) {
  AddSequence("room", "true");
  experiment_.repeat = 2;
  Sweep();
  const double ate = Table().rows[1].figures.At("ate_m");
  options_.row_file = folder_ / "rows.csv";
  AddToRowFile(Table(), options_.row_file);
  fs::remove_all(folder_ / "out");
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_EQ(Starts("room"), 2);
  EXPECT_EQ(Table().rows[1].status, "complete");
  EXPECT_EQ(Table().rows[1].figures.At("ate_m"), ate);
  options_.row_file.clear();
  Sweep();  // As task.json says.
  EXPECT_EQ(Starts("room"), 2);
  experiment_.set.Set("x", "1");
  options_.row_file = folder_ / "rows.csv";
  Sweep();
  EXPECT_EQ(Starts("room"), 4);
}

TEST_F(SweepTest, RefusesAFolderOfSomethingElse) {
  AddSequence("room");
  folder_.Write("out/results.csv", "mine");
  ExpectInputError([&] { Sweep(); }, "results.csv");
  EXPECT_EQ(folder_.Read("out/results.csv"), "mine");
  ExpectInputError([&] { Table(); }, "--output");
  folder_.Write("out/tasks/mine/notes.txt", "mine");
  ExpectInputError([&] { Table(); }, "--output");
}

}  // namespace
}  // namespace splitfusion
