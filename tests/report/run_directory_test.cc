#include "splitfusion/lib/report/run_directory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/report/json_lines.h"
#include "splitfusion/lib/report/library_versions.h"
#include "support/expect_input_error.h"
#include "support/sample_report.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

RunFacts Facts() {
  return {
      "splitfusion", "--preset=splitfusion\n--threads=2", {{"ceres", "2.1.0"}}};
}

TEST(RunPaths, NamesSurfacesAndFrames) {
  const RunPaths paths("run");
  EXPECT_EQ(paths.WarpedMesh(2, "teddy bear", 31),
            "run/surfaces/002_teddy_bear/warped/000031.ply");
  EXPECT_EQ(paths.Surface(0, "background"), "run/surfaces/000_background");
  EXPECT_EQ(paths.Picture(120, "normals"), "run/pictures/000120_normals.png");
  EXPECT_EQ(paths.Mask("1311.25"), "run/masks/1311.25.png");
  EXPECT_EQ(paths.Detections(), "run/detections");
  EXPECT_EQ(RunPaths::SurfaceName(1, "../a"), "001_.._a");
}

TEST(RunPaths, LongAndOddLabelsGiveNamesThatFileSystemsTake) {
  const std::string label(300, 'a');
  EXPECT_EQ(RunPaths::SurfaceName(12, label), "012_" + std::string(60, 'a'));
  EXPECT_EQ(RunPaths::SurfaceName(1, std::string("\xff\0\n", 3)), "001____");
}

TEST(RunDirectory, HoldsEveryFrameBeforeTheEnd) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  run.AddFrame(SampleReport(0), {100.0, Rigid3d::Identity()});
  run.AddFrame(SampleReport(1), {100.5, Rigid3d::Identity()});
  // The run is still open, as after a crash.
  const auto frames = ReadJsonLines(run.paths().Frames());
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1]["frame"], 1);
  const Trajectory poses = ReadTumTrajectory(run.paths().Trajectory());
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].timestamp, 100.5);
  EXPECT_NE(folder.Read("run/iterations.csv").find("\n1,1,0,rigid,"),
            std::string::npos);
  EXPECT_FALSE(folder.Has("run/summary.json"));
  EXPECT_FALSE(folder.Has("run/solver"));
}

TEST(RunDirectory, OptionsRepeatTheRunAndStateVersions) {
  const TemporaryFolder folder;
  const RunDirectory run(folder / "run", Facts());
  EXPECT_EQ(folder.Read("run/options.flags"),
            "# ceres 2.1.0\n--preset=splitfusion\n--threads=2\n");
}

TEST(RunDirectory, FinishWritesTheSummaryOfTheContract) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  run.AddFrame(SampleReport(0), {});
  run.AddWritingSeconds(3);
  run.Finish();
  const auto json = nlohmann::json::parse(folder.Read("run/summary.json"));
  for (const char* key :
       {"complete", "frames", "lost_frames", "seconds_per_frame",
        "seconds_writing", "peak_memory_bytes", "surfaces", "versions",
        "preset", "status", "error", "resumed_at", "loops"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"read", "segment", "split", "render", "associate",
                          "solve", "fuse", "mesh"}) {
    EXPECT_TRUE(json["seconds_per_frame"]["parts"].contains(key)) << key;
  }
  EXPECT_GE(json["seconds_writing"], 3.0);
  EXPECT_GT(json["peak_memory_bytes"], 1 << 20);
  EXPECT_EQ(json["versions"]["ceres"], "2.1.0");
}

TEST(RunDirectory, WritesSolverTextsOnRequest) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  FrameReport report = SampleReport(4);
  report.surfaces[1].rounds[0].solver.full_report = "Solver Summary";
  run.AddFrame(report, {});
  EXPECT_EQ(folder.Read("run/solver/000004.txt"),
            "== surface 1 (teddy bear), round 0, rigid\nSolver Summary\n");
}

TEST(RunDirectory, TheSummarySaysWhetherTheRunIsComplete) {
  const TemporaryFolder folder;
  const RunPaths paths(folder / "run");
  EXPECT_FALSE(IsComplete(paths));
  const RunDirectory run(folder / "run", Facts());
  EXPECT_FALSE(IsComplete(paths));
  run.Finish({RunStatus::kIncomplete, "", {}, {}});
  EXPECT_FALSE(IsComplete(paths));
  run.Finish();
  EXPECT_TRUE(IsComplete(paths));
  folder.Write("run/summary.json", "{\"complete\": \"yes\"}");
  EXPECT_FALSE(IsComplete(paths));
}

TEST(RunDirectory, CountsAllTimeByTheClockAlsoBeforeItWasResumed) {
  const TemporaryFolder folder;
  const RunFacts facts = Facts();
  std::stringstream state;
  RunDirectory run(folder / "run", facts);
  run.AddFrame(SampleReport(0), {});
  const double before = run.Summary().all_seconds_per_frame;
  EXPECT_GT(before, 0);
  EXPECT_LE(before, facts.since_start.Seconds());
  ArchiveWriter writer(&state);
  writer(run);
  writer.Flush();
  RunDirectory resumed(folder / "run", Facts(), /*goes_on=*/true);
  ArchiveReader reader(&state, state.str().size(), "state");
  reader(resumed);
  EXPECT_GT(resumed.time_before().wall, before);
  EXPECT_GT(resumed.Summary().all_seconds_per_frame,
            resumed.time_before().wall);
}

TEST(RunDirectory, GoesOnFromItsState) {
  const TemporaryFolder folder;
  std::stringstream state;
  RunDirectory whole(folder / "whole", Facts());
  RunDirectory killed(folder / "killed", Facts());
  for (int frame = 0; frame < 4; ++frame) {
    whole.AddFrame(SampleReport(frame), {100.0 + frame, Rigid3d::Identity()});
    if (frame == 3) continue;
    killed.AddFrame(SampleReport(frame), {100.0 + frame, Rigid3d::Identity()});
    if (frame != 1) continue;
    ArchiveWriter writer(&state);
    writer(killed);
    writer.Flush();
  }
  RunDirectory resumed(folder / "killed", Facts(), /*goes_on=*/true);
  ArchiveReader reader(&state, state.str().size(), "state");
  reader(resumed);
  for (int frame = 2; frame < 4; ++frame) {
    resumed.AddFrame(SampleReport(frame), {100.0 + frame, Rigid3d::Identity()});
  }
  for (const std::string file :
       {"frames.jsonl", "iterations.csv", "trajectory.txt"}) {
    EXPECT_EQ(folder.Read("killed/" + file), folder.Read("whole/" + file));
  }
  EXPECT_EQ(resumed.Summary().frames, 4);
}

TEST(RunDirectory, DoesNotGoOnWithStreamsThatWereCut) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  run.AddFrame(SampleReport(0), {});
  std::stringstream state;
  ArchiveWriter writer(&state);
  writer(run);
  writer.Flush();
  std::filesystem::resize_file(folder / "run/frames.jsonl", 10);
  RunDirectory resumed(folder / "run", Facts(), /*goes_on=*/true);
  ArchiveReader reader(&state, state.str().size(), "state");
  ExpectInputError([&] { reader(resumed); }, "frames.jsonl");
}

TEST(ReadJsonLines, LeavesOutACutLineAndNamesABrokenOne) {
  const TemporaryFolder folder;
  const auto cut = folder.Write("cut.jsonl", "{\"frame\":0}\n{\"fra");
  EXPECT_EQ(ReadJsonLines(cut).size(), 1u);
  const auto broken = folder.Write("broken.jsonl", "{}\n7\n");
  try {
    ReadJsonLines(broken);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("broken.jsonl:2"),
              std::string::npos);
  }
}

TEST(LibraryVersions, NamesTheLibrariesThatDecideTheResult) {
  const auto versions = LibraryVersions();
  for (const char* name : {"ceres", "eigen", "opencv", "openvdb", "tbb"}) {
    ASSERT_EQ(versions.count(name), 1u) << name;
    EXPECT_NE(versions.at(name).find('.'), std::string::npos) << name;
  }
}

TEST(RunDirectory, TrajectoryStreamIsTheFileWrittenAtOnce) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  Trajectory poses(2);
  poses[1].timestamp = 0.5;
  poses[1].world_from_camera.linear() = ExpSo3({0.1, -0.2, 0.3});
  poses[1].world_from_camera.translation() << 1, -2, 3;
  for (const TimedPose& pose : poses) run.AddFrame(SampleReport(0), pose);
  WriteTumTrajectory(folder / "at_once.txt", poses);
  EXPECT_EQ(folder.Read("run/trajectory.txt"), folder.Read("at_once.txt"));
}

TEST(RunDirectory, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", Facts());
  folder.Write("run/solver", "a file where a folder should be");
  FrameReport report = SampleReport(0);
  report.surfaces[0].rounds[0].solver.full_report = "text";
  try {
    run.AddFrame(report, {});
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("solver/000000.txt"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace splitfusion
