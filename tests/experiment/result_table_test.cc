#include "splitfusion/lib/experiment/result_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "experiment/sweep_fixture.h"
#include "splitfusion/lib/experiment/foreign_results.h"
#include "splitfusion/lib/experiment/result_files.h"
#include "support/expect_input_error.h"
#include "support/repository.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(SweepTest, DamagedFilesAreTheStatusOfTheirRow) {
  AddSequence("room", "true");
  experiment_.grid = ParseGrid("x=1,2,3,4,5,6,7", "grid");
  Sweep();
  folder_.Write(InRun(0, "summary.json"), R"({"complete": "yes"})");
  folder_.Write(InRun(1, "evaluation.json"), R"({"headline": {"ate)");
  folder_.Write(InRun(2, "run.json"), "{");
  fs::remove(folder_ / InRun(3, "evaluation.json"));
  folder_.Write(InRun(4, "../task.json"), "[");
  folder_.Write(InRun(5, "evaluation.json"), R"({"headline": 5})");
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 7u);
  const std::vector<std::string> expected = {
      "damaged: summary.json: expected a number 'frames'",
      "damaged: evaluation.json: expected JSON",
      "damaged: run.json: expected the marker of a run",
      "damaged: evaluation.json: missing",
      "complete",  // By its run directory.
      "damaged: evaluation.json: expected an object 'headline'",
      "complete"};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(table.rows[i].status, expected[i]);
    EXPECT_EQ(std::isfinite(table.rows[i].figures.At("ate_m")),
              expected[i] == "complete");
  }
  EXPECT_EQ(Sweep().failed, 0);  // Mends them all.
  for (const ResultRow& row : Table().rows) EXPECT_EQ(row.status, "complete");
}

TEST_F(SweepTest, AFileThatIsNotAsItWasWrittenIsDamage) {
  AddSequence("room");
  Sweep();
  folder_.Write(InRun(0, "trajectory.txt"), "1 2 3");
  ListFiles(0);
  EXPECT_EQ(Table().rows[0].status, "complete");
  folder_.Write(InRun(0, "trajectory.txt"), "1 2");
  EXPECT_EQ(Table().rows[0].status, "damaged: trajectory.txt was changed");
  folder_.Write(InRun(0, "summary.json"), R"({"frames": 11})");
  EXPECT_EQ(Table().rows[0].status,
            "damaged: summary.json: not as it was written");
}

TEST_F(SweepTest, ACopiedTaskIsNoFurtherRepeat) {
  AddSequence("room", "true");
  Sweep();
  const fs::path task = folder_ / InRun(0, "..");
  const fs::path copy = folder_ / "out/tasks/copy_of_room";
  fs::copy(fs::canonical(task), copy, fs::copy_options::recursive);
  EXPECT_EQ(Table().rows.size(), 1u);
}

TEST_F(SweepTest, LostRecordsAndRunsLeaveTheirRows) {
  AddSequence("room", "true");
  experiment_.repeat = 2;
  Sweep();
  fs::remove_all(folder_ / "out/experiments");
  EXPECT_EQ(Table().rows.size(), 2u);
  fs::remove_all(folder_ / InRun(1, ""));
  EXPECT_THAT(Table().rows[1].status, StartsWith("damaged: run.json"));
}

TEST_F(SweepTest, ARunLeftInTheMiddleOfBeingDoneAgainHasNoFigures) {
  AddSequence("room", "true");
  Sweep();
  const std::string record = InRun(0, "../task.json");
  std::string text = folder_.Read(record);
  const std::string state = R"("state": "complete")";
  text.replace(text.find(state), state.size(), R"("state": "checking")");
  folder_.Write(record, text);
  EXPECT_EQ(Table().rows[0].status, "complete");  // Was only looked at.
  folder_.Write(InRun(0, "unfinished/run.json"), "{}");
  EXPECT_EQ(Table().rows[0].status, "unfinished");
}

std::string Query(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  std::string answer;
  sqlite3_open(path.c_str(), &database);
  sqlite3_exec(
      database, sql.c_str(),
      [](void* out, int count, char** values, char**) {
        for (int i = 0; i < count; ++i) {
          *static_cast<std::string*>(out) +=
              std::string(values[i] ? values[i] : "null") + ";";
        }
        return 0;
      },
      &answer, nullptr);
  sqlite3_close(database);
  return answer;
}

TEST_F(SweepTest, FilesHoldTheTable) {
  AddSequence("room", "true");
  AddSequence("bad");
  experiment_.grid = {{"terms.arap.weight", {"4"}}, {"x", {"a,b"}}};
  Sweep();
  const FileTable file = ResultsTable(Table());
  WriteCsv(folder_ / "r.csv", file);
  WriteSqlite(folder_ / "r.sqlite", {file});
  WriteSqlite(folder_ / "r.sqlite", {file});  // Replaces it.
  EXPECT_THAT(
      folder_.Read("r.csv"),
      StartsWith("task,sequence,repeat,status,terms.arap.weight,x,frames,"
                 "lost_frames,ate_m,rpe_m,rpe_deg,tracks_mean_m,"
                 "tracks_median_m,surface_error_m,f_score_seen,view_error_m,"
                 "missing,stretched,ghosts,seconds_per_frame,"
                 "cpu_seconds_per_frame,peak_memory_bytes\nroom_"));
  EXPECT_THAT(folder_.Read("r.csv"),
              HasSubstr(",room,0,complete,4,\"a,b\",10,1,0."));
  EXPECT_THAT(folder_.Read("r.csv"),
              HasSubstr(",bad,0,failed,4,\"a,b\",,,,,,,,,,,,,,,,\n"));
  const std::string path = folder_ / "r.sqlite";
  EXPECT_EQ(
      Query(path,
            "SELECT sequence, status, repeat, frames, \"terms.arap.weight\""
            " * 2, f_score_seen, rpe_m FROM results ORDER BY 1"),
      "bad;failed;0;null;8.0;null;null;"
      "room;complete;0;10;8.0;0.5;null;");
}

TEST(Results, ColumnsAreDocumented) {
  std::ifstream stream(RepositoryRoot() / "docs/experiments.md");
  if (!stream) GTEST_SKIP() << "not built in the repository";
  const std::string page{std::istreambuf_iterator<char>(stream), {}};
  for (const std::string column : kFigureNames) {
    EXPECT_THAT(page, HasSubstr("`" + column + "`"));
  }
}

TEST_F(SweepTest, OtherSystemsAreRows) {
  AddSequence("room", "true");
  Sweep();
  std::string poses;
  for (const char* pose :
       {"1 0 0 0", "2 0.1 0 0", "3 0.2 0.1 0", "4 0 0 0.3"}) {
    poses += std::string(pose) + " 0 0 0 1\n";
  }
  folder_.Write("data/room/groundtruth.txt", poses);
  const std::string estimate = folder_.Write("est.txt", poses);
  const ExperimentFolder folder(options_.output);
  AddForeignResults(folder, ParseForeignResults("elastic:room=" + estimate));
  const ResultTable table = Table();
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.keys, std::vector<std::string>{"row"});
  EXPECT_EQ(table.rows[1].values[0], "elastic");
  EXPECT_EQ(table.rows[1].status, "complete");
  EXPECT_NEAR(table.rows[1].figures.At("ate_m"), 0, 1e-9);
  EXPECT_TRUE(std::isnan(table.rows[1].figures.At("ghosts")));
  ExpectInputError([] { ParseForeignResults("room=a.txt"); }, "NAME:SEQUENCE");
  ExpectInputError([] { ParseForeignResults("a:room=x; a:room=y"); },
                   "one result of a system on a sequence");
  ExpectInputError(
      [&] {
        AddForeignResults(folder, {{"x", "none", estimate, ""}});
      },
      "expected a sequence of this experiment");
}

}  // namespace
}  // namespace splitfusion
