#include "splitfusion/pipelines/sequence_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/synthetic/synthetic_writer.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "support/expect_input_error.h"
#include "support/synthetic_run.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

constexpr int kFrames = 4;

/// A sequence on disk and runs over it, without masks.
class SequenceRunTest : public ::testing::Test {
 protected:
  void SetUp() override {
    SyntheticOptions scene = SyntheticRun::Quick();
    scene.frames = kFrames;
    WriteSyntheticSequence(scene, {}, sequence());
    options_.pictures_every = 0;
  }

  std::string sequence() const { return folder_ / "sequence"; }
  std::string root() const { return folder_ / "run"; }
  std::string unfinished() const { return root() + "/unfinished"; }

  std::unique_ptr<Reconstruction> Make() const {
    return std::make_unique<Reconstruction>(
        sequence(), ReaderOptions(), PipelineOptions(), LabelTable(),
        [](const ImageFolderReader&) { return nullptr; });
  }

  RunSummary Execute(const SequenceRunHooks& hooks) {
    RunFolder folder(root(), {{{"solver", "gn_pcg"}}, {}}, {});
    SequenceRun run(
        Make(), [this] { return Make(); }, &folder, options_, hooks);
    run.Execute();
    return run.Summary();
  }

  TemporaryFolder folder_;
  SequenceRunOptions options_;
};

TEST_F(SequenceRunTest, TellsHowFarItIsAndLeavesAWholeRun) {
  std::map<RunPass, std::vector<int>> done;
  SequenceRunHooks hooks;
  hooks.shown = [&](const RunProgress& progress) {
    EXPECT_EQ(progress.total, progress.pass == RunPass::kRefining
                                  ? progress.surfaces
                                  : kFrames);
    EXPECT_EQ(progress.seconds_left > 0,
              progress.pass == RunPass::kTracking && progress.done < kFrames);
    done[progress.pass].push_back(progress.done);
  };
  EXPECT_EQ(Execute(hooks).frames, kFrames);
  EXPECT_EQ(done[RunPass::kTracking], (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(done[RunPass::kRefining].front(), 1);
  EXPECT_EQ(done[RunPass::kColoring], (std::vector<int>{1, 2, 3, 4}));
  const auto marker = ReadRunMarker(root());
  ASSERT_TRUE(marker);
  EXPECT_EQ(marker->status, RunStatus::kComplete);
  EXPECT_EQ(marker->files.count("trajectory.txt"), 1u);
  EXPECT_FALSE(std::filesystem::exists(unfinished()));
}

TEST_F(SequenceRunTest, ImagesThatAreGoneAtTheEndGiveNoColors) {
  ASSERT_EQ(Execute({}).frames, kFrames);
  const TriangleMesh colored =
      ReadPly(root() + "/surfaces/000_background/mesh.ply");
  std::filesystem::remove_all(root());
  SequenceRunHooks hooks;
  std::vector<std::string> warnings;
  hooks.warn = [&](const std::string& line) { warnings.push_back(line); };
  hooks.shown = [&](const RunProgress& progress) {
    if (progress.pass == RunPass::kTracking && progress.done == kFrames) {
      std::filesystem::remove_all(sequence() + "/depth");
    }
  };
  EXPECT_EQ(Execute(hooks).frames, kFrames);
  EXPECT_EQ(ReadRunMarker(root())->status, RunStatus::kComplete);
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const std::string& line) {
                            return line.find("from 4 of 4 frames") !=
                                   std::string::npos;
                          }),
            1);
  const TriangleMesh fused =
      ReadPly(root() + "/surfaces/000_background/mesh.ply");
  EXPECT_EQ(fused.vertices, colored.vertices);
  EXPECT_NE(fused.colors, colored.colors);
}

TEST_F(SequenceRunTest, AFailureAtWritingTheResultsIsRecordedAndMended) {
  SequenceRunHooks hooks;
  options_.checkpoint_every = 1;
  hooks.shown = [&](const RunProgress& progress) {
    // A folder where the summary is to be.
    if (progress.done == kFrames) {
      folder_.Write("run/unfinished/summary.json/in_the_way", "");
    }
  };
  ExpectInputError([&] { Execute(hooks); }, "summary.json");
  EXPECT_FALSE(std::filesystem::exists(root() + "/run.json"));
  const auto begun = ReadRunMarker(unfinished());
  ASSERT_TRUE(begun);
  EXPECT_EQ(begun->status, RunStatus::kFailed);
  EXPECT_NE(begun->error.find("summary.json"), std::string::npos);

  std::filesystem::remove_all(unfinished() + "/summary.json");
  EXPECT_EQ(Execute({}).frames, kFrames);
  EXPECT_EQ(ReadRunMarker(root())->resumed_at, std::vector<int>{kFrames - 1});
}

TEST_F(SequenceRunTest, AnInterruptionIsAskedForBeforeEveryFrame) {
  SequenceRunHooks hooks;
  int frames = 0;
  hooks.interrupted = [&] { return frames == 2; };
  hooks.shown = [&](const RunProgress& progress) { frames = progress.done; };
  EXPECT_THROW(Execute(hooks), std::runtime_error);
  EXPECT_EQ(ReadRunMarker(root())->status, RunStatus::kIncomplete);
  // Passes over all frames are made once there are all of them.
  EXPECT_FALSE(folder_.Has("run/refinement.jsonl"));
  std::vector<std::string> told;
  hooks = {};
  hooks.tell = [&](const std::string& line) { told.push_back(line); };
  EXPECT_EQ(Execute(hooks).frames, kFrames);
  EXPECT_TRUE(folder_.Has("run/refinement.jsonl"));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("goes on after 2 of 4 frames"), std::string::npos);
}

TEST_F(SequenceRunTest, APassOverAllFramesCanBeInterruptedAndMadeLater) {
  ASSERT_EQ(Execute({}).frames, kFrames);
  const auto results = [this] {
    std::vector<std::string> texts;
    for (const char* file : {"trajectory.txt", "refinement.jsonl",
                             "surfaces/000_background/mesh.ply",
                             "surfaces/000_background/motions.bin"}) {
      texts.push_back(folder_.Read(std::string("run/") + file));
    }
    return texts;
  };
  const std::vector<std::string> whole = results();
  for (const RunPass pass : {RunPass::kRefining, RunPass::kColoring}) {
    std::filesystem::remove_all(root());
    SequenceRunHooks hooks;
    bool stops = false;
    hooks.interrupted = [&] { return stops; };
    hooks.shown = [&](const RunProgress& progress) {
      stops = progress.pass == pass && progress.done == 1;
    };
    EXPECT_THROW(Execute(hooks), std::runtime_error);
    EXPECT_EQ(ReadRunMarker(root())->status, RunStatus::kIncomplete);
    EXPECT_EQ(Execute({}).frames, kFrames);
    EXPECT_EQ(ReadRunMarker(root())->resumed_at, std::vector<int>{kFrames});
    EXPECT_EQ(results(), whole);
  }
}

}  // namespace
}  // namespace splitfusion
