// The program sf_evaluate, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/bent_plate.h"
#include "support/expect_refused.h"
#include "support/program.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SfEvaluate : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_evaluate")) {
      GTEST_SKIP() << "sf_evaluate is not built";
    }
    std::filesystem::create_directories(folder_ / "run");
    BentPlate().WriteRun(folder_ / "run");
    BentPlate().WriteGroundTruth(folder_ / "gt");
  }

  static ProgramResult Run(const std::string& arguments) {
    return RunProgram("sf_evaluate", arguments);
  }

  static void ExpectRefused(const std::string& arguments,
                            const std::string& text) {
    splitfusion::ExpectRefused("sf_evaluate", arguments, text);
  }

  TemporaryFolder folder_;
};

TEST_F(SfEvaluate, WritesTheEvaluationOfARun) {
  const ProgramResult result =
      Run("--samples=2000 --track_frames=8 --run=" + (folder_ / "run") +
          " --ground_truth=" + (folder_ / "gt"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("ATE [mm]"), HasSubstr("plate1"),
                                   HasSubstr("tracks: 25 points")));
  const auto json = nlohmann::json::parse(folder_.Read("run/evaluation.json"));
  EXPECT_LT(json["ate"]["rmse"], 1e-6);
  EXPECT_GT(json["background"]["f_score"]["0.01"], 0.999);
  EXPECT_LT(json["tracks"]["visible"]["max"], 0.001);
}

TEST_F(SfEvaluate, JudgesTheModelOfTheFrameOrTheWholeModel) {
  const std::string graph = "run/surfaces/001_thin_plate/graph.json";
  auto json = nlohmann::json::parse(folder_.Read(graph));
  json["first_seen"] = std::vector<int>(json["positions"].size(), 3);
  folder_.Write(graph, json.dump());
  // Nothing was seen of it in frame 0.
  for (const bool whole : {false, true}) {
    const ProgramResult result =
        Run("--samples=2000 --run=" + (folder_ / "run") + " --ground_truth=" +
            (folder_ / "gt") + (whole ? " --whole_model" : ""));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const auto found =
        nlohmann::json::parse(folder_.Read("run/evaluation.json"));
    EXPECT_EQ(found["whole_model"], whole);
    const auto& frame = found["instances"][0]["frames"][0]["surface"];
    EXPECT_EQ(frame["f_score"]["0.02"], whole ? 1 : 0);
  }
  ExpectRefused("--whole_model --trajectory=a --ground_truth=b",
                "--whole_model needs --run");
}

TEST_F(SfEvaluate, JudgesWhatHadBeenSeenAndNothingElse) {
  BentPlate().WriteSequence(folder_ / "sequence", folder_ / "run");
  EXPECT_EQ(Run("--with_unknown --run=" + (folder_ / "run")).exit_code, 0);
  ExpectRefused("--nowith_unknown --run=" + (folder_ / "run"),
                "--with_unknown cannot be switched off");
}

TEST_F(SfEvaluate, NeedsNoTruthToCompareTheModelWithTheLiveDepth) {
  const std::string arguments = "--depth_every=3 --run=" + (folder_ / "run");
  ProgramResult result = Run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("options.flags: no --sequence"));
  BentPlate().WriteSequence(folder_ / "sequence", folder_ / "run");
  result = Run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("1 thin_plate"));
  const auto json = nlohmann::json::parse(folder_.Read("run/evaluation.json"));
  EXPECT_EQ(json["depth_agreement"][1]["frames"], 4);
  EXPECT_LT(json["depth_agreement"][1]["distances"]["median"], 0.0005);
}

TEST_F(SfEvaluate, SaysWhenTheRunIsUnfinished) {
  const std::string arguments = "--depth_every=0 --run=" + (folder_ / "run");
  const std::string text = "/run: unfinished run (summary.json is missing";
  folder_.Write("run/summary.json", "{\"complete\": true}");
  ProgramResult result = Run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, testing::Not(HasSubstr("unfinished")));
  folder_.Write("run/summary.json", "{\"complete\": false}");
  EXPECT_THAT(Run(arguments).output, HasSubstr(text));
  std::filesystem::remove(folder_ / "run/summary.json");
  result = Run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr(text));
  folder_.Write("begun/unfinished/run.json", "{}");
  result = Run("--run=" + (folder_ / "begun"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors,
              HasSubstr("/begun: holds an unfinished run alone"));
}

TEST_F(SfEvaluate, FollowsQueryPoints) {
  folder_.Write("q.csv", "id,frame,x,y,z\n0,0,0.1,0,1\n4,0,0,0,0.5\n");
  const ProgramResult result =
      Run("--track_frames=3 --run=" + (folder_ / "run") + " --track_query=" +
          (folder_ / "q.csv") + " --track_output=" + (folder_ / "p.csv"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string rows = folder_.Read("p.csv");
  EXPECT_THAT(rows, StartsWith("id,frame,x,y,z\n0,0,0.100000,0.000000,1.0"));
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 2 * 4);
  EXPECT_FALSE(folder_.Has("run/evaluation.json"));
}

TEST_F(SfEvaluate, ComparesFilesAlone) {
  ProgramResult result =
      Run("--trajectory=" + (folder_ / "run/trajectory.txt") +
          " --ground_truth=" + (folder_ / "gt/groundtruth.txt"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("12 of 12 poses matched"));
  result = Run("--samples=1000 --mesh=" + (folder_ / "gt/static_mesh.ply") +
               " --ground_truth_mesh=" + (folder_ / "gt/static_mesh.ply") +
               " --output=" + (folder_ / "mesh.json"));
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(folder_.Read("mesh.json"));
  EXPECT_EQ(json["f_score"]["0.02"], 1);
}

TEST_F(SfEvaluate, BadUsageAndInputEndWithTwoAndOneLine) {
  ExpectRefused("", "expected one of --run, --trajectory, --mesh");
  ExpectRefused("--no_such_flag=1", "unknown command line flag");
  ExpectRefused("--samples=many", "illegal value 'many'");
  ExpectRefused("--flagfile=/no/such/file", "/no/such/file");
  ExpectRefused("run", "argument 'run': expected flags only");
  ExpectRefused("--run=/no/such/run --ground_truth=x", "/no/such/run");
  ExpectRefused("--track_frame=3,x --run=" + (folder_ / "run"),
                "track_frame = 3,x: expected frame indices");
  ExpectRefused("--depth_every=-1 --run=" + (folder_ / "run"),
                "depth_every = -1");
  ExpectRefused("--trajectory=a --ground_truth=b", "a: cannot be opened");
  ExpectRefused("--mesh=a.ply", "go together");
  folder_.Write("empty.txt", "# nothing\n");
  ExpectRefused("--trajectory=" + (folder_ / "empty.txt") +
                    " --ground_truth=" + (folder_ / "gt/groundtruth.txt"),
                "empty.txt: no pose");
  folder_.Write("late.txt", "9999 0 0 0 0 0 0 1\n");
  ExpectRefused("--trajectory=" + (folder_ / "late.txt") +
                    " --ground_truth=" + (folder_ / "gt/groundtruth.txt"),
                "0 of 1 estimated poses match");
}

TEST_F(SfEvaluate, HelpFitsAScreenAndNamesOnlyOwnFlags) {
  const ProgramResult result = Run("--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("--track_query"));
  EXPECT_THAT(result.output, testing::Not(HasSubstr("--tab_completion")));
  EXPECT_LT(std::count(result.output.begin(), result.output.end(), '\n'), 50);
}

TEST_F(SfEvaluate, TruthOfTheSharedDataComparesWithItself) {
  const std::string truth = SharedData("selfie/gt/groundtruth.txt");
  SKIP_WITHOUT_SHARED_DATA(truth, "selfie/gt/groundtruth.txt");
  const ProgramResult result =
      Run("--trajectory=" + truth + " --ground_truth=" + truth);
  EXPECT_THAT(result.output, HasSubstr("80 of 80 poses matched, path 0.942 m"));
}

}  // namespace
}  // namespace splitfusion
