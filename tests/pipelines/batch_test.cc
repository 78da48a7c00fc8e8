#include "splitfusion/pipelines/batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/pipelines/child_process.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

// Understands --sequence, --output, --flagfile as sf_run does; fails for the
// sequence "bad", and counts how often it ran.
constexpr const char* kFakeRun = R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in
    --sequence=*) sequence="${argument#*=}" ;;
    --output=*) output="${argument#*=}" ;;
    --flagfile=*) flags=$(cat "${argument#*=}") ;;
  esac
done
echo "reading $sequence $flags"
echo x >> "$output/../../starts.txt"
case "$sequence" in
  *bad) echo "warning" >&2; echo "bad/rgb.txt: cannot be opened" >&2; exit 2 ;;
  *crash) kill -SEGV $$ ;;
  *endless) trap 'echo "interrupted after 4 frames" >&2; exit 1' INT
            touch "$output/started"
            while :; do sleep 0.05; done ;;
esac
case "$sequence" in
  *cut) echo '{"complete": false, "frames": 4}' > "$output/summary.json"
        echo "cut/depth/5.png: is broken" >&2; exit 2 ;;
esac
echo '{"complete": true, "frames": 10, "lost_frames": 1, "peak_memory_bytes": 1048576,
  "seconds_per_frame": {"median": 0.5, "mean": 0.75}}' > "$output/summary.json"
)";

constexpr const char* kFakeEvaluate = R"(#!/bin/sh
run="${1#*=}"; truth="${2#*=}"
grep -q broken "$truth/groundtruth.txt" && { echo "no pose" >&2; exit 2; }
echo '{"ate": {"rmse": 0.0125}}' > "$run/evaluation.json"
)";

class BatchTest : public testing::Test {
 protected:
  BatchTest() {
    options_.run_program = Program("sf_run", kFakeRun);
    options_.evaluate_program = Program("sf_evaluate", kFakeEvaluate);
    options_.output = folder_ / "out";
  }

  std::string Program(const std::string& name, const std::string& text) {
    const std::string path = folder_.Write("bin/" + name, text);
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }

  void AddSequence(const std::string& name) {
    folder_.Write("data/" + name + "/rgb.txt", "");
    options_.sequences.push_back(folder_ / ("data/" + name));
  }

  /// How often sf_run was started.
  std::size_t Starts() const {
    return folder_.Read("out/starts.txt").size() / 2;
  }

  TemporaryFolder folder_;
  BatchOptions options_;
};

TEST_F(BatchTest, RunsEverySequenceWithEveryOptionFile) {
  AddSequence("room");
  AddSequence("desk");
  options_.option_files = {folder_.Write("a.flags", "--lambda=5"),
                           folder_.Write("b.flags", "--lambda=9")};
  const auto results = RunBatch(options_);
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[3].run.sequence, "desk");
  EXPECT_EQ(results[3].run.options, "b");
  EXPECT_EQ(results[3].figures.frames, 10);
  EXPECT_EQ(results[3].figures.seconds_median, 0.5);
  EXPECT_TRUE(std::isnan(results[3].figures.ate_rmse_m));  // No ground truth.
  EXPECT_EQ(CountFailed(results), 0);
  EXPECT_NE(folder_.Read("out/desk/b/run.log").find("data/desk --lambda=9"),
            std::string::npos);
}

TEST_F(BatchTest, EvaluatesWhereAGroundTruthIs) {
  AddSequence("room");
  AddSequence("desk");
  folder_.Write("data/room/gt/groundtruth.txt", "");
  folder_.Write("data/desk/groundtruth.txt", "broken");
  const auto results = RunBatch(options_);
  EXPECT_EQ(results[0].figures.ate_rmse_m, 0.0125);
  EXPECT_EQ(results[1].exit_code, 2);
  EXPECT_EQ(results[1].error, "no pose");
  EXPECT_EQ(results[1].figures.frames, 10);  // The run itself is good.
  options_.ground_truth = "none";
  options_.overwrite = true;
  EXPECT_TRUE(std::isnan(RunBatch(options_)[0].figures.ate_rmse_m));
}

TEST_F(BatchTest, FailingRunsAreRecordedAndNotFatal) {
  for (const char* name : {"bad", "crash", "room"}) AddSequence(name);
  const auto results = RunBatch(options_);
  EXPECT_EQ(results[0].exit_code, 2);
  EXPECT_EQ(results[0].error, "bad/rgb.txt: cannot be opened");
  EXPECT_EQ(results[1].exit_code, 128 + 11);
  EXPECT_EQ(results[1].error, "ended by signal 11");
  EXPECT_EQ(results[2].exit_code, 0);
  EXPECT_EQ(CountFailed(results), 2);
}

TEST_F(BatchTest, FinishedRunsAreKeptAndFailedOnesRepeated) {
  for (const char* name : {"bad", "room"}) AddSequence(name);
  RunBatch(options_);
  EXPECT_EQ(Starts(), 2u);
  auto results = RunBatch(options_);
  EXPECT_EQ(Starts(), 3u);  // Only "bad" again.
  EXPECT_TRUE(results[1].skipped);
  EXPECT_EQ(results[1].figures.frames, 10);
  options_.overwrite = true;
  results = RunBatch(options_);
  EXPECT_EQ(Starts(), 5u);
  EXPECT_FALSE(results[1].skipped);
}

TEST_F(BatchTest, ARunThatKeptAPartIsNoSuccess) {
  AddSequence("cut");
  for (int i = 0; i < 2; ++i) {
    const auto results = RunBatch(options_);
    EXPECT_EQ(results[0].exit_code, 2);
    EXPECT_FALSE(results[0].skipped);
    EXPECT_EQ(results[0].figures.frames, 4);
  }
  EXPECT_EQ(Starts(), 2u);
}

TEST_F(BatchTest, ResultsKeepTheirOrderWithSeveralJobs) {
  for (const char* name : {"a", "b", "bad", "c", "d"}) AddSequence(name);
  options_.jobs = 3;
  int calls = 0;
  const auto results = RunBatch(options_, [&](const BatchProgress& progress) {
    EXPECT_EQ(progress.done, ++calls);
    EXPECT_EQ(progress.total, 5);
  });
  EXPECT_EQ(calls, 5);
  ASSERT_EQ(results.size(), 5u);
  EXPECT_EQ(results[2].run.sequence, "bad");
  EXPECT_EQ(results[4].run.sequence, "d");
}

TEST_F(BatchTest, SummariesHoldTheTable) {
  AddSequence("bad");
  AddSequence("room");
  folder_.Write("data/room/groundtruth.txt", "");
  const auto results = RunBatch(options_);
  const auto json = nlohmann::json::parse(folder_.Read("out/summary.json"));
  ASSERT_EQ(json.size(), 2u);
  EXPECT_TRUE(json[0]["frames"].is_null());
  EXPECT_EQ(json[1]["ate_rmse_m"], 0.0125);
  const std::string csv = folder_.Read("out/summary.csv");
  EXPECT_NE(
      csv.find("/room/default,0,0,,10,1,0.0125,,,,,,,,,,0.5,0.75,1048576\n"),
      std::string::npos);
  const std::string table = FormatBatchTable(results);
  EXPECT_NE(table.find("0.0125"), std::string::npos);
  EXPECT_NE(table.find("bad/rgb.txt: cannot be opened"), std::string::npos);
}

TEST_F(BatchTest, SequencesComeFromListsAndFolders) {
  AddSequence("room");
  AddSequence("desk");
  const auto list = folder_.Write("list.txt", "# two\ndata/room  # first\n\n");
  const auto sequences = ReadSequences(list + "," + folder_ / "data/desk");
  ASSERT_EQ(sequences.size(), 2u);
  EXPECT_TRUE(fs::equivalent(sequences[0], folder_ / "data/room"));
  EXPECT_THROW(ReadSequences(""), InputError);
  EXPECT_THROW(ReadSequences(folder_ / "none"), InputError);
}

TEST_F(BatchTest, RefusesWhatCannotRun) {
  EXPECT_THROW(PlanBatch(options_), InputError);  // No sequence.
  AddSequence("room");
  EXPECT_NO_THROW(PlanBatch(options_));
  BatchOptions options = options_;
  options.jobs = 0;
  EXPECT_THROW(PlanBatch(options), InputError);
  options = options_;
  options.run_program = folder_ / "bin/none";
  EXPECT_THROW(PlanBatch(options), InputError);
  options = options_;
  options.option_files = {folder_ / "none.flags"};
  EXPECT_THROW(PlanBatch(options), InputError);
  options = options_;
  options.sequences.push_back((folder_ / "data/room") + "/");  // Same name.
  EXPECT_THROW(PlanBatch(options), InputError);
}

TEST_F(BatchTest, ChildKeepsTheLastVersionOfAProgressLine) {
  const auto program = Program(
      "progress", "#!/bin/sh\nprintf 'frame 1\\rframe 2\\n' >&2; exit 4\n");
  const ChildResult result = RunChild({program}, folder_ / "progress");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.last_error_line, "frame 2");
  EXPECT_EQ(RunChild({folder_ / "none"}, folder_ / "none").exit_code, 127);
}

TEST_F(BatchTest, StopsTheRunningChildAndStartsNoOther) {
  for (const char* name : {"room", "endless", "desk"}) AddSequence(name);
  const auto results = RunBatch(options_, {}, [&] {
    return folder_.Has("out/endless/default/started") ? Stop::kWhenReady
                                                      : Stop::kNo;
  });
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].exit_code, 0);
  EXPECT_EQ(results[1].exit_code, 1);
  EXPECT_EQ(results[1].error, "interrupted after 4 frames");
  EXPECT_EQ(Starts(), 2u);
  EXPECT_EQ(nlohmann::json::parse(folder_.Read("out/summary.json")).size(), 2u);
}

TEST_F(BatchTest, BrokenFilesOfARunGiveNoFigures) {
  folder_.Write("run/summary.json", "{\"frames\": 4, \"lost_frames\": null}");
  folder_.Write("run/evaluation.json", "{\"ate\": ");
  const BatchFigures figures = ReadFigures(folder_ / "run");
  EXPECT_EQ(figures.frames, 4);
  EXPECT_TRUE(std::isnan(figures.lost_frames));
  EXPECT_TRUE(std::isnan(figures.ate_rmse_m));
  EXPECT_TRUE(std::isnan(figures.seconds_median));
}

TEST_F(BatchTest, ErrorsAreMeansOverTheInstancesThatHaveThem) {
  folder_.Write("run/evaluation.json", R"({"ate": {"rmse": 0.5},
    "background": {"accuracy": {"mean": 0.25},
                   "completeness": {"mean": 0.125, "within": {"0.02": 0.75}}},
    "tracks": {"visible": {"median": 0.0625, "mean": 0.375}},
    "instances": [
      {"surface": {"accuracy": {"mean": 0.5}, "f_score": {"0.02": 0.875}},
       "frames": [
        {"view": {"pixels": 100, "distances":
          {"count": 50, "mean": 0.25, "within": {"0.02": 1}}}},
        {"view": null},
        {"view": {"pixels": 300, "distances":
          {"count": 150, "mean": 0.75, "within": {"0.02": 0.5}}}}]},
      {"surface": null, "frames": [{"view": {"pixels": 8, "distances":
          {"count": 0, "mean": 0, "within": {"0.02": 0}}}}]},
      {"surface": null, "frames": []}]})");
  const BatchFigures figures = ReadFigures(folder_ / "run");
  EXPECT_EQ(figures.ate_rmse_m, 0.5);
  EXPECT_EQ(figures.background_accuracy_m, 0.25);
  EXPECT_EQ(figures.background_completeness, 0.75);
  EXPECT_EQ(figures.objects_view_m, 0.625);   // By pixels; of one instance.
  EXPECT_EQ(figures.objects_right, 0.15625);  // (125 / 400 + 0) / 2.
  EXPECT_EQ(figures.objects_uncovered, 0.75);
  EXPECT_EQ(figures.objects_accuracy_m, 0.5);
  EXPECT_EQ(figures.objects_f_score, 0.875);
  EXPECT_EQ(figures.track_median_m, 0.0625);
  EXPECT_EQ(figures.track_mean_m, 0.375);
}

TEST_F(BatchTest, WithoutMovingTruthTheirErrorsAreUnknown) {
  folder_.Write("run/evaluation.json",
                R"({"ate": {"rmse": 0.5}, "background": null,
                    "instances": [], "tracks": null})");
  const BatchFigures figures = ReadFigures(folder_ / "run");
  EXPECT_EQ(figures.ate_rmse_m, 0.5);
  EXPECT_TRUE(std::isnan(figures.background_accuracy_m));
  EXPECT_TRUE(std::isnan(figures.objects_view_m));
  EXPECT_TRUE(std::isnan(figures.objects_right));
  EXPECT_TRUE(std::isnan(figures.objects_uncovered));
  EXPECT_TRUE(std::isnan(figures.objects_accuracy_m));
  EXPECT_TRUE(std::isnan(figures.track_mean_m));
}

TEST_F(BatchTest, GroundTruthMayLieElsewhere) {
  AddSequence("room");
  AddSequence("desk");
  folder_.Write("truth/room/groundtruth.txt", "");
  folder_.Write("data/desk/groundtruth.txt", "");
  options_.ground_truth = folder_ / "truth";
  const auto plan = PlanBatch(options_);
  EXPECT_EQ(plan[0].ground_truth, folder_ / "truth/room");
  EXPECT_EQ(plan[1].ground_truth, "");
  options_.ground_truth = "atuo";
  EXPECT_THROW(PlanBatch(options_), InputError);
}

}  // namespace
}  // namespace splitfusion
