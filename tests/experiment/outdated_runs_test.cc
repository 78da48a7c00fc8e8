#include "splitfusion/lib/experiment/outdated_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/sweep_fixture.h"
#include "splitfusion/lib/experiment/repeats.h"
#include "splitfusion/lib/experiment/result_statistics.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

/// Repeats whose options stand in a flagfile.
class OutdatedRuns : public SweepTest {
 protected:
  OutdatedRuns() {
    AddSequence("room", "true");
    WriteWeight("4");
    experiment_.set.Set("flagfile", folder_ / "a.flags");
  }

  void WriteWeight(const std::string& weight) const {
    folder_.Write("a.flags", "weight " + weight);
  }
};

TEST_F(OutdatedRuns, RepeatsWithDifferentOptionsAreNotAveraged) {
  experiment_.repeat = 4;
  Sweep();
  EXPECT_EQ(OutdatedText(Table()), "");
  WriteWeight("64");
  experiment_.repeat = 2;
  Sweep();
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[1].status, "complete");
  EXPECT_EQ(table.rows[2].status, "outdated: flags weight 4 -> weight 64");
  EXPECT_TRUE(std::isnan(table.rows[2].figures.At("ate_m")));
  EXPECT_EQ(GroupResults(table)[0].runs, 2);
  EXPECT_EQ(GroupResults(table)[0].planned, 4);
  EXPECT_THAT(OutdatedText(table), HasSubstr("2 of 4 runs are outdated"));
  EXPECT_THAT(OutdatedText(table), HasSubstr("weight 4 -> weight 64"));
  experiment_.repeat = 4;
  Sweep();
  EXPECT_EQ(OutdatedText(Table()), "");
  EXPECT_EQ(Starts("room"), 8);
}

TEST_F(OutdatedRuns, AFlagfileThatIsEditedDuringTheSweepIsNoticed) {
  experiment_.repeat = 3;
  const SweepOutcome outcome =
      RunSweep(experiment_, options_,
               [&](const SweepProgress& /*progress*/) { WriteWeight("64"); });
  EXPECT_EQ(outcome.failed, 2);
  EXPECT_EQ(Table().rows[0].status, "complete");
  EXPECT_EQ(Table().rows[2].status, "failed");
  EXPECT_THAT(Table().rows[2].error,
              HasSubstr("changed while the experiment went on: flags weight 4 "
                        "-> weight 64"));
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_EQ(Starts("room"), 4);  // The one of before.
  EXPECT_EQ(OutdatedText(Table()), "");
}

TEST_F(OutdatedRuns, RunsOfASequenceAreJudgedAlike) {
  experiment_.evaluate.Set("track_frames", "5");
  experiment_.grid = ParseGrid("x=1", "grid");
  Sweep();
  experiment_.evaluate.Set("track_frames", "6");
  experiment_.grid = ParseGrid("x=2", "grid");
  Sweep();
  EXPECT_EQ(Table().rows[0].status, "outdated: evaluate.track_frames 5 -> 6");
  EXPECT_EQ(Table().rows[1].status, "complete");
}

TEST_F(OutdatedRuns, AChangedGroundTruthIsEvaluatedAgain) {
  Sweep();
  folder_.Write("data/room/groundtruth.txt", "other");
  EXPECT_EQ(DryRun(experiment_, options_)[0].second,
            "to be evaluated: ground_truth changed");
  Sweep();
  EXPECT_EQ(Starts("room"), 1);
  EXPECT_EQ(Lines("data/room/evaluations.txt"), 2);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("kept, evaluated again: ground_truth changed"));
}

TEST_F(OutdatedRuns, AnEvaluationByHandIsNotTaken) {
  Sweep();
  const std::string file = InRun(0, "evaluation.json");
  const std::string own = folder_.Read(file);
  folder_.Write(file, R"({"headline": {"ate_m": 9}})");
  EXPECT_EQ(Table().rows[0].status, "outdated: evaluated by hand");
  EXPECT_TRUE(std::isnan(Table().rows[0].figures.At("ate_m")));
  EXPECT_EQ(DryRun(experiment_, options_)[0].second,
            "to be evaluated: evaluated by hand");
  Sweep();
  EXPECT_EQ(Table().rows[0].status, "complete");
  EXPECT_EQ(folder_.Read(file), own);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("kept, evaluated again: evaluated by hand"));
}

TEST_F(OutdatedRuns, AGroundTruthThatIsGoneIsMissed) {
  Sweep();
  const double ate = Table().rows[0].figures.At("ate_m");
  std::filesystem::remove(folder_ / "data/room/groundtruth.txt");
  experiment_.sequences = ReadSequences(folder_ / "data/room", "auto");
  EXPECT_EQ(Sweep().failed, 0);
  EXPECT_EQ(Table().rows[0].figures.At("ate_m"), ate);
  EXPECT_THAT(folder_.Read("out/progress.log"),
              HasSubstr("kept, and its evaluation, for ground truth is gone"));
  WriteWeight("8");  // What is computed anew cannot be judged.
  EXPECT_EQ(Sweep().failed, 1);
  EXPECT_EQ(Table().rows[0].status, "not evaluated");
  EXPECT_THAT(Table().rows[0].error, HasSubstr("ground truth is gone"));
}

TEST(Repeats, DifferInMillionthsOfTheirVoxelsOnly) {
  const NamedValues run = {{"object_voxel", "0.004"},
                           {"background_voxel", "0.01"}};
  NamedValues repeat = run;
  const Settings shifted = ShiftVoxels(run, 3);
  for (const auto& [key, value] : shifted.entries()) {
    repeat[key] = value;
  }
  EXPECT_NE(run, repeat);
  EXPECT_EQ(DifferencesBeyondRepeats(run, repeat), "");
  repeat["object_voxel"] = "0.0041";
  EXPECT_EQ(DifferencesBeyondRepeats(run, repeat),
            "object_voxel 0.004 -> 0.0041");
}

}  // namespace
}  // namespace splitfusion
