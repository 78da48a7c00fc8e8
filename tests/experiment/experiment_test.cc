#include "splitfusion/lib/experiment/experiment.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "splitfusion/lib/experiment/sequence_list.h"
#include "splitfusion/lib/experiment/task.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class ExperimentTest : public testing::Test {
 protected:
  ExperimentTest() {
    folder_.Write("data/room/gt/groundtruth.txt", "");
    folder_.Write("data/desk/rgb.txt", "");
  }
  Experiment Read(const std::string& text) const {
    return ReadExperiment(folder_.Write("e.json", text));
  }
  TemporaryFolder folder_;
};

constexpr const char* kText = R"({
  "about": "test",
  "sequences": ["data/room", {"folder": "data/desk", "name": "table",
                              "set": {"max_frames": 5}}],
  "set": {"max_frames": 9, "full_report": true},
  "grid": {"terms.arap.weight": [4, 8.5, "16"]},
  "rows": [{"name": "base"}, {"name": "no_bend", "set": {"prior_anneal": 1}}],
  "repeat": 2, "baseline": "base"})";

TEST_F(ExperimentTest, PlansEveryCombination) {
  const auto tasks = PlanTasks(Read(kText));
  ASSERT_EQ(tasks.size(), 2u * 3 * 2 * 2);
  EXPECT_EQ(SettingsText(tasks[0].settings),
            "max_frames=9; full_report=true; terms.arap.weight=4");
  EXPECT_EQ(tasks[0].ground_truth, folder_ / "data/room/gt");
  EXPECT_EQ(tasks[1].repeat, 1);
  EXPECT_EQ(tasks.back().sequence, "table");
  EXPECT_EQ(tasks.back().ground_truth, "");
  EXPECT_EQ(tasks.back().row, "no_bend");
  EXPECT_EQ(SettingsText(tasks.back().settings),
            "max_frames=5; full_report=true; prior_anneal=1; "
            "terms.arap.weight=16");
  std::set<std::string> names;
  for (const Task& task : tasks) names.insert(task.name);
  EXPECT_EQ(names.size(), tasks.size());
}

TEST_F(ExperimentTest, IsReadBackAsItWasSaved) {
  const Experiment experiment = Read(kText);
  const auto json = ToJson(experiment);
  std::filesystem::remove_all(folder_ / "data");
  const Experiment saved = SavedExperiment(json);
  EXPECT_EQ(ToJson(saved), json);
  EXPECT_EQ(PlanTasks(saved).back().name, PlanTasks(experiment).back().name);
  const Task task = PlanTasks(saved).back();
  EXPECT_EQ(ToJson(TaskFromJson(ToJson(task))), ToJson(task));
}

TEST_F(ExperimentTest, ATaskHasItsNameWhereverItsSettingsComeFrom) {
  Experiment a = Read(R"({"sequences": ["data/room"],
                          "set": {"x": 1, "y": 2}})");
  Experiment b = Read(R"({"sequences": ["data/room"], "set": {"y": 2},
                          "grid": {"x": [1, 3]}})");
  EXPECT_EQ(PlanTasks(a)[0].name, PlanTasks(b)[0].name);
  EXPECT_NE(PlanTasks(a)[0].name, PlanTasks(b)[1].name);
}

TEST_F(ExperimentTest, SaysWhatIsWrong) {
  const auto expect = [&](const std::string& text, const std::string& part) {
    ExpectInputError([&] { PlanTasks(Read(text)); }, part);
  };
  expect("{", "expected JSON");
  expect("{}", "sequences");
  expect(R"({"sequnces": []})", "'sequnces': expected one of");
  expect(R"({"sequences": ["data/none"]})", "not found");
  expect(R"({"sequences": ["data/room", "data/room"]})", "different names");
  expect(R"({"sequences": ["data/room"], "set": {"output": "x"}})", "output");
  expect(R"({"sequences": ["data/room"], "set": {"x": [1]}})", "set.x");
  expect(R"({"sequences": ["data/room"], "repeat": 0})", "repeat");
  expect(R"({"sequences": ["data/room"], "rows": [{}]})", "'name'");
  expect("{\n\"repeat\": 1,,\n}", "line 2");
  const std::string file = folder_ / "e.json: ";
  expect(R"({"repeat": 0})", file + "repeat = 0");
  expect(R"({"grid": {"x": [4, "4.0"]}})", file + "grid = 'x=4.0'");
  expect(R"({"evaluate": {"run": "x"}})", file + "evaluate = run");
  ExpectInputError([] { ReadExperiment("none.json"); }, "none.json");
}

TEST_F(ExperimentTest, SequencesComeFromListsAndFolders) {
  const std::string list =
      folder_.Write("list.txt", "# two\ndata/room  # first\n\n");
  const auto sequences =
      ReadSequences(list + "," + (folder_ / "data/desk/"), "auto");
  ASSERT_EQ(sequences.size(), 2u);
  EXPECT_EQ(sequences[0].folder, folder_ / "data/room");
  EXPECT_EQ(sequences[1].name, "desk");
  const std::string recording = folder_.Write("data/scene.sens", "");
  ASSERT_EQ(ReadSequences(recording, "auto").size(), 1u);
  EXPECT_EQ(ReadSequences(recording, "auto")[0].folder, recording);
  folder_.Write("truth/desk/groundtruth.txt", "");
  const auto with_truth =
      ReadSequences(folder_ / "data/desk", folder_ / "truth");
  EXPECT_EQ(with_truth[0].ground_truth, folder_ / "truth/desk");
  EXPECT_EQ(ReadSequences(folder_ / "data/room", "none")[0].ground_truth, "");
  ExpectInputError([&] { ReadSequences(folder_ / "data/room", "atuo"); },
                   "ground_truth");
}

}  // namespace
}  // namespace splitfusion
