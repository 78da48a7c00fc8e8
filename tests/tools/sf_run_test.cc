// sf_synth, sf_run and sf_evaluate, as others call them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"
#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

int LineCount(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

/// Lines of a trajectory that are no comment.
std::vector<std::string> Poses(const std::string& text) {
  std::stringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  }
  return lines;
}

TEST_F(SfRun, WarpedMeshesHoldWhatWasSeenByThenOrAll) {
  Synthesize("--frames=16 --subject_speed=2");  // Enough to show other sides.
  // Triangles of the person's mesh that a warped mesh lacks.
  const auto missing = [&](const std::string& run, const std::string& frame) {
    const std::string surface = folder_ / (run + "/surfaces/001_person/");
    return ReadPly(surface + "mesh.ply").triangles.size() -
           ReadPly(surface + "warped/" + frame + ".ply").triangles.size();
  };
  const std::string flags = "--warped_every=15 --pictures_every=0 ";
  ASSERT_EQ(Run("seen", flags).exit_code, 0);
  ASSERT_EQ(Run("whole", flags + "--warped_whole").exit_code, 0);
  EXPECT_GT(missing("seen", "000000"), 0u);
  EXPECT_LT(missing("whole", "000000"), missing("seen", "000000"));
  EXPECT_EQ(missing("whole", "000015"), missing("seen", "000015"));
}

TEST_F(SfRun, WritesWhatTheContractNames) {
  Synthesize();
  const ProgramResult result =
      Run("run",
          "--warped_every=2 --pictures_every=3 --full_report "
          "--solver=ceres --solver_iterations=1");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* name : {"trajectory.txt",
                           "summary.json",
                           "frames.jsonl",
                           "iterations.csv",
                           "options.flags",
                           "report.html",
                           "refinement.jsonl",
                           "surfaces/000_background/mesh.ply",
                           "surfaces/000_background/tsdf.vdb",
                           "surfaces/000_background/graph.json",
                           "surfaces/000_background/motions.bin",
                           "surfaces/001_person/mesh.ply",
                           "surfaces/001_person/tsdf.vdb",
                           "surfaces/001_person/graph.json",
                           "surfaces/001_person/motions.bin",
                           "surfaces/001_person/warped/000000.ply",
                           "surfaces/001_person/warped/000002.ply",
                           "pictures/000000_montage.png",
                           "pictures/000003_composite.png",
                           "pictures/000003_normals.png",
                           "solver/000001.txt"}) {
    EXPECT_TRUE(folder_.Has(std::string("run/") + name)) << name;
  }
  EXPECT_FALSE(folder_.Has("run/surfaces/001_person/warped/000001.ply"));
  EXPECT_FALSE(folder_.Has("run/pictures/000001_montage.png"));
  EXPECT_EQ(Poses(folder_.Read("run/trajectory.txt")).size(), 4u);
  EXPECT_EQ(LineCount(folder_.Read("run/frames.jsonl")), 4);
  const auto summary = nlohmann::json::parse(folder_.Read("run/summary.json"));
  EXPECT_EQ(summary["frames"], 4);
  EXPECT_EQ(summary["lost_frames"], 0);
  for (const char* part : {"read", "segment", "split", "render", "associate",
                           "solve", "fuse", "mesh"}) {
    EXPECT_TRUE(summary["seconds_per_frame"]["parts"].contains(part)) << part;
  }
  EXPECT_GT(summary["peak_memory_bytes"], 1000000);
  EXPECT_EQ(summary["surfaces"][0]["label"], "background");
  EXPECT_GT(summary["surfaces"][1]["vertices"], 1000);
}

TEST_F(SfRun, IsEvaluatedAndRepeatedByItsOwnFlagfile) {
  Synthesize();
  ASSERT_EQ(Run("run",
                "--max_frames=3 --pictures_every=0 --warped_every=0 "
                "--threads=2")
                .exit_code,
            0);
  const ProgramResult evaluation =
      RunProgram("sf_evaluate",
                 "--samples=500 --track_frames=2 --run=" + (folder_ / "run") +
                     " --ground_truth=" + (folder_ / "sequence/gt"));
  EXPECT_EQ(evaluation.exit_code, 0) << evaluation.errors;
  const auto json = nlohmann::json::parse(folder_.Read("run/evaluation.json"));
  EXPECT_LT(json["ate"]["rmse"], 0.05);
  const ProgramResult repeated = RunProgram(
      "sf_run", "--flagfile=" + (folder_ / "run/options.flags") +
                    " --output=" + (folder_ / "again") + " --threads=1");
  ASSERT_EQ(repeated.exit_code, 0) << repeated.errors;
  for (const char* file :
       {"trajectory.txt", "surfaces/000_background/mesh.ply",
        "surfaces/001_person/mesh.ply", "surfaces/001_person/motions.bin"}) {
    const std::string name = std::string("/") + file;
    EXPECT_FALSE(folder_.Read("run" + name).empty()) << file;
    EXPECT_EQ(folder_.Read("again" + name), folder_.Read("run" + name)) << file;
  }
}

TEST_F(SfRun, ABrokenFrameIsFoundBeforeTheFirstOne) {
  Synthesize();
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder_ / "sequence/depth")) {
    images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  fs::resize_file(images.at(2), fs::file_size(images.at(2)) / 2);
  const ProgramResult refused = Run("run", "--pictures_every=0");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr(images.at(2).filename().string()));
  EXPECT_FALSE(folder_.Has("run"));
  const ProgramResult skipped =
      Run("skipped", "--pictures_every=0 --skip_bad_frames");
  EXPECT_EQ(skipped.exit_code, 0) << skipped.errors;
  EXPECT_THAT(skipped.errors, HasSubstr("1 frame is left out: "));
  const auto json = nlohmann::json::parse(folder_.Read("skipped/summary.json"));
  EXPECT_EQ(json["skipped_frames"], nlohmann::json::array({2}));
  EXPECT_EQ(json["frames"], 3);
}

TEST_F(SfRun, AFrameThatCannotBeDecodedEndsTheRunAndKeepsWhatWasComputed) {
  Synthesize();
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder_ / "sequence/depth")) {
    images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  // Head and end are whole, what is between is not.
  std::fstream image(images.at(2), std::ios::in | std::ios::out);
  image.seekp(fs::file_size(images.at(2)) / 2);
  image << std::string(200, 'x');
  image.close();
  const ProgramResult result = Run("run", "--pictures_every=0");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr(images.at(2).filename().string()));
  EXPECT_EQ(Poses(folder_.Read("run/trajectory.txt")).size(), 2u);
  EXPECT_EQ(LineCount(folder_.Read("run/frames.jsonl")), 2);
  EXPECT_TRUE(folder_.Has("run/surfaces/000_background/mesh.ply"));
  EXPECT_TRUE(folder_.Has("run/surfaces/001_person/mesh.ply"));
  const auto summary = nlohmann::json::parse(folder_.Read("run/summary.json"));
  EXPECT_EQ(summary["frames"], 2);
  EXPECT_EQ(summary["complete"], false);
}

TEST_F(SfRun, AFlagfileWithAnUnknownFlagIsRefused) {
  const std::string file =
      folder_.Write("bad.flags", "# mine\n--threads=1\n--bogus=1\n");
  ExpectRefused("sf_run", "--flagfile=" + file,
                "bad.flags, line 3: unknown flag 'bogus'");
}

TEST_F(SfRun, MasksThatFitNoFrameAreRefused) {
  Synthesize();
  const fs::path masks = fs::path(folder_ / "sequence") / "masks_noisy";
  fs::create_directories(folder_ / "other");
  for (const auto& entry : fs::directory_iterator(masks)) {
    if (entry.path().extension() != ".png") continue;
    fs::copy(entry.path(), fs::path(folder_ / "other") /
                               ("x" + entry.path().filename().string()));
  }
  const ProgramResult result = Run("run", "--masks=" + (folder_ / "other"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("no mask for any of the"));
}

TEST_F(SfRun, WhatIsReadIsNotOverwritten) {
  Synthesize();
  fs::create_directories(folder_ / "run");
  fs::copy(fs::path(folder_ / "sequence") / "masks_noisy",
           folder_ / "run/masks", fs::copy_options::recursive);
  folder_.Write("run/options.flags", "");
  const ProgramResult result =
      Run("run", "--overwrite --masks=" + (folder_ / "run/masks"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("outside of --output"));
  EXPECT_TRUE(folder_.Has("run/masks"));
}

TEST_F(SfRun, BadUsageEndsWithTwoAndOneLine) {
  ExpectRefused("sf_run", "", "--sequence = '': expected the folder");
  ExpectRefused("sf_run", "--sequence=x", "--output = ''");
  ExpectRefused("sf_run", "--no_such_flag=1", "unknown command line flag");
  ExpectRefused("sf_run", "--threads=two", "illegal value 'two'");
  ExpectRefused("sf_run", "leftover", "argument 'leftover'");
  const std::string missing = folder_ / "missing";
  ExpectRefused("sf_run",
                "--sequence=" + missing + " --output=" + (folder_ / "run"),
                missing);
  EXPECT_FALSE(folder_.Has("run"));
}

TEST_F(SfRun, BadOptionsEndWithTwoAndLeaveNothing) {
  Synthesize();
  const std::string start = "--sequence=" + (folder_ / "sequence") +
                            " --output=" + (folder_ / "run") + " ";
  const auto refused = [&](const std::string& option, const std::string& text) {
    ExpectRefused("sf_run", start + option, text);
  };
  refused("--preset=fusion", "--preset = fusion: expected background_only");
  refused("--solver=lm", "--solver = lm: expected gn_pcg");
  refused("--association=flow", "--association = flow: expected projective");
  refused("--format=kitti", "--format = kitti: expected bonn, icl_nuim, tum");
  refused("--terms=arapp", "term = arapp: expected point_to_plane");
  refused("--linear_solver=lu", "--linear_solver = lu: expected auto");
  refused("--object_voxel=0", "--object_voxel = 0: expected 0.001..1");
  refused("--mask_kind=soft", "--mask_kind = soft: expected rigid");
  refused("--masks=/no/such/folder", "/no/such/folder");
  refused("--intrinsics=1,2", "--intrinsics=1,2: expected fx,fy,cx,cy");
  refused("--intrinsics=50,50,32,24,64,48,9", "9: expected fx,fy,cx,cy");
  refused("--max_frames=-1", "--max_frames = -1");
  EXPECT_FALSE(folder_.Has("run"));
}

TEST_F(SfRun, TheSameImagesInAnotherFormatAreTheSameRun) {
  Synthesize();
  int index = 0;
  std::set<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder_ / "sequence/rgb")) {
    images.insert(entry.path().filename());
  }
  folder_.Make("scene");
  for (const fs::path& image : images) {
    const std::string stem =
        folder_ / ("scene/frame-00000" + std::to_string(index++));
    fs::copy(folder_ / "sequence/rgb" / image, stem + ".color.png");
    fs::copy(folder_ / "sequence/depth" / image, stem + ".depth.png");
  }
  fs::copy(folder_ / "sequence/calibration.txt",
           folder_ / "scene/calibration.txt");
  EXPECT_EQ(Run("tum", "--masks=none").exit_code, 0);
  const ProgramResult result =
      RunProgram("sf_run", "--masks=none --sequence=" + (folder_ / "scene") +
                               " --output=" + (folder_ / "scenes"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string motions = "/surfaces/000_background/motions.bin";
  EXPECT_FALSE(folder_.Read("tum" + motions).empty());
  EXPECT_EQ(folder_.Read("tum" + motions), folder_.Read("scenes" + motions));
  EXPECT_THAT(folder_.Read("tum/options.flags"), HasSubstr("--format=tum\n"));
  EXPECT_THAT(folder_.Read("scenes/options.flags"),
              HasSubstr("--format=7scenes\n"));
  // Live depth is read by the same format.
  const ProgramResult evaluated =
      RunProgram("sf_evaluate", "--run=" + (folder_ / "scenes"));
  EXPECT_EQ(evaluated.exit_code, 0) << evaluated.errors;
  EXPECT_THAT(folder_.Read("scenes/evaluation.json"), HasSubstr("depth"));
}

TEST_F(SfRun, GivenPosesAreThoseOfTheCamera) {
  Synthesize();
  const std::string truth = folder_ / "sequence/gt/groundtruth.txt";
  const ProgramResult result =
      Run("given", "--trajectory=" + truth + " --pictures_every=0");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Trajectory own = ReadTumTrajectory(folder_ / "given/trajectory.txt");
  const Trajectory given = ReadTumTrajectory(truth);
  ASSERT_EQ(own.size(), 4u);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Rigid3d expected =
        given[0].world_from_camera.inverse() * given[i].world_from_camera;
    EXPECT_TRUE(own[i].world_from_camera.isApprox(expected, 1e-6)) << i;
  }
  ExpectRefused("sf_run",
                "--sequence=" + (folder_ / "sequence") + " --output=" +
                    (folder_ / "none") + " --trajectory=none.txt",
                "none.txt");
  ExpectRefused("sf_run",
                "--sequence=" + (folder_ / "sequence") +
                    " --output=" + (folder_ / "none") +
                    " --preset=dynamicfusion --trajectory=" + truth,
                "expected a background that does not deform");
  ExpectRefused("sf_run",
                "--sequence=" + (folder_ / "sequence") + " --output=" +
                    (folder_ / "none") + " --mask_identities=known",
                "--mask_identities = known: expected given, or nothing");
}

TEST_F(SfRun, WarnsOnceOfEveryGraphThatIsCoarserThanPlanned) {
  Synthesize();
  const ProgramResult result =
      Run("run", "--max_nodes=20 --pictures_every=0 --warped_every=0");
  EXPECT_EQ(result.exit_code, 0);
  const auto summary = nlohmann::json::parse(folder_.Read("run/summary.json"));
  const auto& person = summary["surfaces"][1];
  ASSERT_EQ(person["label"], "person");
  EXPECT_GT(person["node_spacing"], 0.04);
  const std::string text = "surface 1 (person) has nodes every ";
  const std::size_t first = result.errors.find(text);
  ASSERT_NE(first, std::string::npos) << result.errors;
  EXPECT_EQ(result.errors.find(text, first + 1), std::string::npos);
  EXPECT_THAT(result.errors,
              AllOf(HasSubstr(" mm instead of 40 mm, to keep --max_nodes=20"),
                    testing::Not(HasSubstr("(background) has nodes"))));
}

TEST_F(SfRun, RefusesToOverwriteUnlessTold) {
  Synthesize();
  folder_.Write("run/mine.txt", "do not touch");
  EXPECT_EQ(Run("run", "--max_frames=1").exit_code, 2);
  EXPECT_EQ(folder_.Read("run/mine.txt"), "do not touch");
  EXPECT_EQ(Run("run", "--max_frames=1 --overwrite").exit_code, 2);
  EXPECT_EQ(folder_.Read("run/mine.txt"), "do not touch");
  EXPECT_EQ(Run("other", "--max_frames=1").exit_code, 0);
  folder_.Write("other/mine.txt", "do not touch");
  EXPECT_EQ(Run("other", "--max_frames=2").exit_code, 2);
  EXPECT_EQ(Run("other", "--max_frames=2 --overwrite").exit_code, 0);
  EXPECT_EQ(folder_.Read("other/mine.txt"), "do not touch");
}

TEST_F(SfRun, EnergiesOfPapersAreTermsThatFlagsOverrule) {
  Synthesize("--frames=1");
  const auto identity = [&](const std::string& flags) {
    const ProgramResult result = Run("run", "--print_identity " + flags);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output)["identity"];
  };
  const std::string own = "point_to_plane arap(weight=3)";
  EXPECT_EQ(identity("--energy=splitfusion"),
            identity("--terms='point_to_plane(weight=1) arap(weight=8)'"));
  EXPECT_NE(identity("--energy=splitfusion"), identity(""));
  EXPECT_EQ(identity("--energy=volumedeform --terms='" + own + "'"),
            identity("--terms='" + own + "'"));
  EXPECT_EQ(identity("--energy=splitfusion --set=terms.arap.weight=3"),
            identity("--terms='" + own + "'"));
  EXPECT_EQ(identity("--set=energy=splitfusion"),
            identity("--energy=splitfusion"));
  ExpectRefused("sf_run", "--sequence=none --output=none --energy=best",
                "--energy = best: expected splitfusion, ");
}

TEST_F(SfRun, PresetsAreDefaultsThatFlagsOverrule) {
  Synthesize("--frames=1");
  const auto identity = [&](const std::string& flags) {
    return Run("none", "--print_identity " + flags).output;
  };
  EXPECT_THAT(identity(""), HasSubstr("\"deform_objects\": \"true\""));
  EXPECT_THAT(identity("--preset=cofusion"),
              HasSubstr("\"deform_objects\": \"false\""));
  EXPECT_THAT(identity("--preset=cofusion --deform_objects"),
              HasSubstr("\"deform_objects\": \"true\""));
}

TEST_F(SfRun, HelpNamesOwnFlagsAndFitsAScreen) {
  const ProgramResult result = RunProgram("sf_run", "--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_LE(std::count(result.output.begin(), result.output.end(), '\n'), 50);
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 80u) << line;
  }
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("--sequence"), HasSubstr("--linear_solver"),
                    HasSubstr("--solver_iterations")));
}

TEST_F(SfRun, SynthRefusesBadUsage) {
  const std::string output = " --output=" + (folder_ / "sequence");
  ExpectRefused("sf_synth", "", "--output");
  ExpectRefused("sf_synth", "--scene=moon" + output, "moon");
  ExpectRefused("sf_synth", "--frames=0" + output, "frames = 0");
  ExpectRefused("sf_synth", "--width=10" + output, "width = 10");
  EXPECT_FALSE(folder_.Has("sequence"));
  folder_.Write("sequence/mine.txt", "do not touch");
  ExpectRefused("sf_synth", output, folder_ / "sequence");
  ExpectRefused("sf_synth", "--overwrite" + output, folder_ / "sequence");
  EXPECT_EQ(folder_.Read("sequence/mine.txt"), "do not touch");
}

}  // namespace
}  // namespace splitfusion
