#include "splitfusion/lib/report/run_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

RunIdentity Weight(const std::string& weight) {
  return {{{"terms.arap.weight", weight}, {"solver", "gn_pcg"}},
          {{"warped_every", "10"}}};
}

const RunFolderOptions kOverwrite = {true, false, true};
const RunFolderOptions kKeepSame = {true, true, true};

class RunFolderTest : public ::testing::Test {
 protected:
  RunFolder Open(const std::string& weight,
                 const RunFolderOptions& options = {}) const {
    return RunFolder(root(), Weight(weight), options);
  }

  std::string root() const { return folder_ / "run"; }

  void WriteBegun(const std::string& name, const std::string& text) const {
    folder_.Write("run/unfinished/" + name, text);
  }

  /// A whole run whose trajectory holds `text`.
  void Finish(const std::string& weight, const std::string& text,
              const RunFolderOptions& options = {}) const {
    RunFolder run = Open(weight, options);
    ASSERT_EQ(run.start(), RunStart::kFresh);
    WriteBegun("trajectory.txt", text);
    WriteBegun("surfaces/000_" + text + "/mesh.ply", text);
    EXPECT_TRUE(run.Publish(RunStatus::kComplete));
  }

  /// A run that was killed after a checkpoint.
  void Kill(const std::string& weight, const std::string& text,
            const RunFolderOptions& options = {}) const {
    const RunFolder run = Open(weight, options);
    WriteBegun("trajectory.txt", text);
    WriteBegun("checkpoint.bin", "state of " + text);
  }

  std::string Trajectory() const { return folder_.Read("run/trajectory.txt"); }

  TemporaryFolder folder_;
};

TEST_F(RunFolderTest, AWholeRunIsPutInPlaceWithItsMarker) {
  Finish("8", "first");
  EXPECT_EQ(Trajectory(), "first");
  EXPECT_FALSE(folder_.Has("run/unfinished"));
  EXPECT_FALSE(folder_.Has("run/lock"));
  const auto marker = ReadRunMarker(root());
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->status, RunStatus::kComplete);
  EXPECT_EQ(marker->files.size(), 2u);
  EXPECT_TRUE(marker->IsSame(Weight("8")));
}

TEST_F(RunFolderTest, AFinishedRunOfTheSameIdentityIsNotRunAgain) {
  Finish("8", "first");
  EXPECT_EQ(Open("8").start(), RunStart::kFinished);
  EXPECT_EQ(Open("8", kKeepSame).start(), RunStart::kFinished);
  EXPECT_EQ(Open("8", kOverwrite).start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, AnotherIdentityIsRefusedAndSaysWhatDiffers) {
  Finish("8", "first");
  ExpectInputError([&] { Open("4"); }, "terms.arap.weight 8 -> 4");
  EXPECT_EQ(Trajectory(), "first");
  EXPECT_EQ(Open("4", kKeepSame).start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, AFinishedRunThatLacksAFileIsNotFinished) {
  Finish("8", "first");
  fs::remove_all(root() + "/surfaces");
  ExpectInputError([&] { Open("8"); },
                   "surfaces/000_first/mesh.ply is missing");
  {
    const RunFolder again = Open("8", kKeepSame);
    EXPECT_EQ(again.start(), RunStart::kFresh);
    EXPECT_NE(again.note().find("is missing"), std::string::npos);
  }
  Finish("8", "first", kOverwrite);
  folder_.Write("run/evaluation.json", "{}");
  AddRunFile(root(), "evaluation.json");
  fs::remove(root() + "/evaluation.json");  // It can be made again.
  EXPECT_EQ(Open("8").start(), RunStart::kFinished);
}

TEST_F(RunFolderTest, AReportIsAFileAsAllOthers) {
  {
    RunFolder run = Open("8");
    WriteBegun("report.html", "report");
    EXPECT_TRUE(run.Publish(RunStatus::kComplete));
  }
  folder_.Write("run/report.html", "changed");
  EXPECT_EQ(Open("8", kKeepSame).start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, OtherOutputsAreNotTheSameRun) {
  Finish("8", "first");
  RunIdentity other = Weight("8");
  other.outputs["warped_every"] = "1";
  ExpectInputError([&] { RunFolder(root(), other, {}); },
                   "warped_every 10 -> 1");
}

TEST_F(RunFolderTest, AnOlderResultStaysUntilTheNewOneIsWhole) {
  Finish("8", "first");
  Kill("4", "second", kOverwrite);
  EXPECT_EQ(Trajectory(), "first");
  {
    RunFolder failed = Open("2", kOverwrite);
    EXPECT_FALSE(failed.Publish(RunStatus::kFailed, "no disk"));
  }
  EXPECT_EQ(Trajectory(), "first");
  EXPECT_EQ(ReadRunMarker(root())->status, RunStatus::kComplete);
  Finish("2", "third", {true, false, false});
  EXPECT_EQ(Trajectory(), "third");
  EXPECT_FALSE(folder_.Has("run/surfaces/000_first"));
}

TEST_F(RunFolderTest, WhatNoRunWroteStays) {
  Finish("8", "first");
  folder_.Write("run/notes.txt", "mine");
  folder_.Write("run/surfaces/000_first/mine.ply", "mine");
  Finish("4", "second", kOverwrite);
  EXPECT_EQ(folder_.Read("run/notes.txt"), "mine");
  EXPECT_EQ(folder_.Read("run/surfaces/000_first/mine.ply"), "mine");
  EXPECT_FALSE(folder_.Has("run/surfaces/000_first/mesh.ply"));
}

TEST_F(RunFolderTest, WhatSomebodyPutIntoAnUnfinishedRunStays) {
  Kill("8", "begun");
  folder_.Write("run/unfinished/notes.txt", "mine");
  Finish("4", "first", kOverwrite);
  EXPECT_EQ(folder_.Read("run/unfinished/notes.txt"), "mine");
  EXPECT_FALSE(folder_.Has("run/unfinished/trajectory.txt"));
  EXPECT_FALSE(folder_.Has("run/unfinished/run.json"));
  EXPECT_EQ(ReadRunMarker(root())->files.count("notes.txt"), 0u);
  Finish("2", "second", kOverwrite);
  EXPECT_EQ(Trajectory(), "second");
  EXPECT_EQ(folder_.Read("run/unfinished/notes.txt"), "mine");
}

TEST_F(RunFolderTest, AFolderOfOthersNamedAsUnfinishedIsRefused) {
  folder_.Write("run/unfinished/masks/hand_made.png", "mine");
  ExpectInputError([&] { Open("8"); }, "unfinished");
  EXPECT_EQ(folder_.Read("run/unfinished/masks/hand_made.png"), "mine");
}

TEST_F(RunFolderTest, AFailureWhileResultsAreWrittenIsRecorded) {
  {
    RunFolder run = Open("8");
    WriteBegun("checkpoint.bin", "state");
    run.RecordFailure("mesh.ply: cannot be written");
  }
  const auto begun = ReadRunMarker(root() + "/unfinished");
  ASSERT_TRUE(begun);
  EXPECT_EQ(begun->status, RunStatus::kFailed);
  EXPECT_EQ(begun->error, "mesh.ply: cannot be written");
  EXPECT_FALSE(folder_.Has("run/run.json"));
  EXPECT_EQ(Open("8").start(), RunStart::kResumed);
  EXPECT_EQ(ReadRunMarker(root() + "/unfinished")->error, "");
}

TEST_F(RunFolderTest, AChangedFileOfTheOlderRunIsKeptBesides) {
  Finish("8", "first");
  folder_.Write("run/trajectory.txt", "corrected by hand");
  Finish("4", "second", kOverwrite);
  EXPECT_EQ(Trajectory(), "second");
  int kept = 0;
  for (const auto& entry : fs::directory_iterator(root())) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("trajectory.txt.before-", 0) != 0) continue;
    EXPECT_EQ(folder_.Read("run/" + name), "corrected by hand");
    ++kept;
  }
  EXPECT_EQ(kept, 1);
}

TEST_F(RunFolderTest, AFolderOfOthersIsRefused) {
  folder_.Write("run/masks/hand_made.png", "mine");
  folder_.Write("run/options.flags", "--solver=ceres");
  for (const RunFolderOptions& options : {RunFolderOptions{}, kOverwrite}) {
    ExpectInputError([&] { Open("8", options); }, "not a run");
  }
  EXPECT_EQ(folder_.Read("run/masks/hand_made.png"), "mine");
}

TEST_F(RunFolderTest, LogFilesDoNotCount) {
  folder_.Write("run/run.log", "a line");
  EXPECT_EQ(Open("8").start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, AKilledRunGoesOnFromItsCheckpoint) {
  Kill("8", "begun");
  RunFolder run = Open("8");
  EXPECT_EQ(run.start(), RunStart::kResumed);
  EXPECT_EQ(folder_.Read("run/unfinished/checkpoint.bin"), "state of begun");
  run.RecordResumption(7);
  EXPECT_TRUE(run.Publish(RunStatus::kComplete));
  EXPECT_EQ(Trajectory(), "begun");
  EXPECT_EQ(ReadRunMarker(root())->resumed_at, std::vector<int>{7});
  EXPECT_FALSE(folder_.Has("run/checkpoint.bin"));
}

TEST_F(RunFolderTest, AKilledRunOfOtherOptionsIsNotLostInSilence) {
  Kill("8", "begun");
  ExpectInputError([&] { Open("4"); }, "terms.arap.weight 8 -> 4");
  EXPECT_EQ(Open("8").start(), RunStart::kResumed);
  EXPECT_EQ(Open("4", kOverwrite).start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, WithoutACheckpointItBeginsAnew) {
  { const RunFolder run = Open("8"); }
  RunFolder run = Open("8");
  EXPECT_EQ(run.start(), RunStart::kFresh);
}

TEST_F(RunFolderTest, ARefusedOneWasNotKilled) {
  Open("8").RecordFailure("no disk");
  EXPECT_EQ(ReadRunMarker(root() + "/unfinished")->error, "no disk");
  EXPECT_EQ(Open("8").note(), "begins anew: had ended before a checkpoint");
}

TEST_F(RunFolderTest, AnInterruptedRunIsShownAndGoesOn) {
  Kill("8", "half");
  {
    RunFolder run = Open("8");
    WriteBegun("summary.json", "half");
    EXPECT_TRUE(run.Publish(RunStatus::kIncomplete));
  }
  EXPECT_EQ(Trajectory(), "half");
  EXPECT_EQ(ReadRunMarker(root())->status, RunStatus::kIncomplete);
  EXPECT_TRUE(folder_.Has("run/unfinished/checkpoint.bin"));
  RunFolder run = Open("8");
  EXPECT_EQ(run.start(), RunStart::kResumed);
  EXPECT_EQ(folder_.Read("run/unfinished/trajectory.txt"), "half");
  EXPECT_FALSE(folder_.Has("run/unfinished/summary.json"));
  EXPECT_FALSE(folder_.Has("run/run.json"));
  WriteBegun("trajectory.txt", "whole");
  EXPECT_TRUE(run.Publish(RunStatus::kComplete));
  EXPECT_EQ(Trajectory(), "whole");
}

TEST_F(RunFolderTest, AFailureIsNeverASuccess) {
  {
    RunFolder run = Open("8");
    WriteBegun("trajectory.txt", "frozen");
    EXPECT_TRUE(run.Publish(RunStatus::kFailed, "nothing to reconstruct"));
  }
  EXPECT_EQ(ReadRunMarker(root())->error, "nothing to reconstruct");
  EXPECT_NE(Open("8").start(), RunStart::kFinished);
}

TEST_F(RunFolderTest, KilledAnywhereWhileItIsPutInPlaceLosesNothing) {
  for (const PublishingPhase phase :
       {PublishingPhase::kRemoving, PublishingPhase::kMoving}) {
    for (int moved = 0; moved <= 2; ++moved) {
      const TemporaryFolder folder;
      const std::string root = folder / "run";
      const std::string text = "second";
      {
        RunFolder older(root, Weight("8"), {});
        folder.Write("run/unfinished/trajectory.txt", "first");
        older.Publish(RunStatus::kComplete);
      }
      {
        RunFolder newer(root, Weight("4"), kOverwrite);
        folder.Write("run/unfinished/trajectory.txt", text);
        folder.Write("run/unfinished/masks/0.png", text);
        RunMarker marker = newer.marker();
        marker.status = RunStatus::kComplete;
        marker.files = ListRunFiles(root + "/unfinished", {});
        marker.phase = phase;
        WriteRunMarker(root + "/unfinished", marker);
        // What had been done when it was killed.
        const bool moving = phase == PublishingPhase::kMoving;
        if (moving || moved > 0) fs::remove(root + "/trajectory.txt");
        if (moving) fs::remove(root + "/run.json");
        if (moving && moved > 0) {
          fs::rename(root + "/unfinished/trajectory.txt",
                     root + "/trajectory.txt");
        }
        if (moving && moved > 1) {
          fs::create_directories(root + "/masks");
          fs::rename(root + "/unfinished/masks/0.png", root + "/masks/0.png");
        }
      }
      const RunFolder again(root, Weight("4"), {});
      EXPECT_EQ(again.start(), RunStart::kFinished) << moved;
      EXPECT_EQ(folder.Read("run/trajectory.txt"), text);
      EXPECT_EQ(folder.Read("run/masks/0.png"), text);
      EXPECT_FALSE(folder.Has("run/unfinished"));
    }
  }
}

TEST_F(RunFolderTest, OneAtATime) {
  const RunFolder run = Open("8");
  ExpectInputError([&] { Open("8"); }, "is held by process ");
  folder_.Write("other/lock", "");
  ExpectInputError([&] { RunFolder(folder_ / "other", Weight("8"), {}); },
                   "is held by a lock without a name");
}

TEST_F(RunFolderTest, NoticesThatItsFolderIsGone) {
  const RunFolder run = Open("8");
  run.CheckHeld();
  fs::remove_all(root());
  ExpectInputError([&] { run.CheckHeld(); }, "was removed");
  EXPECT_FALSE(folder_.Has("run"));
}

TEST_F(RunFolderTest, ADamagedMarkerIsNamed) {
  Finish("8", "first");
  for (const char* text : {"", "{", "{\"tool\": \"sf_run\"}", "[1]"}) {
    folder_.Write("run/run.json", text);
    ExpectInputError([&] { Open("8"); }, "run.json");
  }
}

TEST_F(RunFolderTest, AMarkerNamesNoFileOutsideOfItsFolder) {
  Finish("8", "first");
  std::string text = folder_.Read("run/run.json");
  const std::string name = "\"trajectory.txt\"";
  text.replace(text.find(name), name.size(), "\"../keep.txt\"");
  folder_.Write("keep.txt", "first");
  folder_.Write("run/run.json", text);
  ExpectInputError([&] { Open("4", kOverwrite); }, "../keep.txt");
  EXPECT_TRUE(folder_.Has("keep.txt"));
}

TEST(CheckRunFile, FindsWhatIsMissingOrDamaged) {
  const TemporaryFolder folder;
  folder.Write("run/motions.bin", "0123456789");
  RunMarker marker;
  marker.files = ListRunFiles(folder / "run", {});
  CheckRunFile(marker, folder / "run", "motions.bin");
  CheckRunFile(marker, folder / "run", "not_listed.txt");
  folder.Write("run/motions.bin", "0123456780");
  ExpectInputError([&] { CheckRunFile(marker, folder / "run", "motions.bin"); },
                   "not as the run wrote it");
  fs::remove(folder / "run/motions.bin");
  ExpectInputError([&] { CheckRunFile(marker, folder / "run", "motions.bin"); },
                   "is missing");
}

TEST(RunIdentity, NamesTheFirstDifferences) {
  EXPECT_EQ(Differences(Weight("8"), Weight("8")), "");
  const NamedValues before = {
      {"a", "1"}, {"b", "2"}, {"c", "3"}, {"d", "4"}, {"e", "5"}};
  EXPECT_EQ(Differences(before, {}),
            "a 1 -> none, b 2 -> none, c 3 -> none and 2 more");
  const std::string hash(32, 'a');
  EXPECT_EQ(Differences(NamedValues{{"input.frames", hash}},
                        NamedValues{{"input.frames", std::string(32, 'b')}}),
            "input.frames changed");
  EXPECT_NE(Weight("8").Hash(), Weight("4").Hash());
  EXPECT_EQ(MethodHash().size(), 32u);
}

}  // namespace
}  // namespace splitfusion
