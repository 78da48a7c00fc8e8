// Runs that are killed, interrupted or fail go on, and lose nothing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "sf_run_fixture.h"
#include "support/repository.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr char kOptions[] =
    "--pictures_every=4 --warped_every=3 --checkpoint_every=3";

class Resume : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (IsSkipped()) return;
    Synthesize("--frames=24 --mesh_every=100");
  }

  std::string Arguments(const std::string& output,
                        const std::string& options) const {
    return "--sequence=" + (folder_ / "sequence") +
           " --output=" + (folder_ / output) + " " + options;
  }

  int FramesBegun(const std::string& run) const {
    const std::string lines = folder_.Read(run + "/unfinished/frames.jsonl");
    return static_cast<int>(std::count(lines.begin(), lines.end(), '\n'));
  }

  /// Sends a signal when so many frames are done (at once for 0); false if the
  /// run had ended before.
  bool Stop(const std::string& run, const std::string& options, int frames,
            int signal, ProgramResult* result = nullptr) const {
    RunningProgram program("sf_run", Arguments(run, options));
    while (program.Runs() && FramesBegun(run) < frames) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    const bool runs = program.Runs();
    program.Send(signal);
    const ProgramResult ended = program.Wait();
    if (result != nullptr) *result = ended;
    return runs;
  }

  static bool HasTimesOrIds(const std::string& path) {
    const std::string name = fs::path(path).filename().string();
    static const std::set<std::string> names = {
        "frames.jsonl", "iterations.csv", "summary.json", "report.html",
        "run.json",     "options.flags",  "tsdf.vdb"};
    return names.count(name) > 0;
  }

  std::set<std::string> Files(const std::string& run) const {
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / run)) {
      if (!entry.is_regular_file()) continue;
      files.insert(fs::relative(entry.path(), folder_ / run).string());
    }
    return files;
  }

  /// The same files with the same bytes, but for those that state times.
  void ExpectSameResult(const std::string& run, const std::string& other) {
    const std::set<std::string> files = Files(run);
    EXPECT_EQ(files, Files(other));
    EXPECT_GT(files.size(), 30u);
    for (const std::string& file : files) {
      if (HasTimesOrIds(file)) continue;
      EXPECT_EQ(folder_.Read(run + "/" + file),
                folder_.Read(other + "/" + file))
          << file;
    }
  }

  Json Summary(const std::string& run) const {
    return Json::parse(folder_.Read(run + "/summary.json"));
  }
};

TEST_F(Resume, AKilledRunEndsWithTheSameBytes) {
  ASSERT_EQ(Run("whole", kOptions).exit_code, 0);
  for (const int frames : {0, 2, 5, 11, 17, 23}) {
    const std::string run = "killed" + std::to_string(frames);
    Stop(run, kOptions, frames, SIGKILL);
    Stop(run, kOptions, std::min(frames + 4, 24), SIGKILL);
    const ProgramResult result = Run(run, kOptions);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    ExpectSameResult("whole", run);
    EXPECT_EQ(Summary(run)["frames"], 24);
  }
}

TEST_F(Resume, AnInterruptedRunIsShownAndEndsWithTheSameBytes) {
  ASSERT_EQ(Run("whole", kOptions).exit_code, 0);
  ProgramResult interrupted;
  ASSERT_TRUE(Stop("run", kOptions, 8, SIGINT, &interrupted));
  EXPECT_EQ(interrupted.exit_code, 1);
  EXPECT_THAT(interrupted.errors, HasSubstr("the same command goes on"));
  EXPECT_EQ(Summary("run")["status"], "incomplete");
  const int done = Summary("run")["frames"];
  ASSERT_EQ(Run("run", kOptions).exit_code, 0);
  ExpectSameResult("whole", "run");
  EXPECT_EQ(Summary("run")["resumed_at"], Json::array({done}));
}

TEST_F(Resume, AFinishedRunIsNotRunAgain) {
  ASSERT_EQ(Run("run", kOptions).exit_code, 0);
  const std::string before = folder_.Read("run/run.json");
  const ProgramResult again =
      Run("run", std::string(kOptions) + " --threads=1");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.output, HasSubstr("nothing to do"));
  EXPECT_EQ(folder_.Read("run/run.json"), before);
  const ProgramResult other =
      Run("run", std::string(kOptions) + " --set=terms.arap.weight=4");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("terms.arap.weight 8 -> 4"));
}

TEST_F(Resume, AnOlderResultOutlivesARunThatIsKilledOrFails) {
  ASSERT_EQ(Run("run", kOptions).exit_code, 0);
  const std::string before = folder_.Read("run/trajectory.txt");
  const std::string other = "--overwrite --max_frames=20";
  ASSERT_TRUE(Stop("run", other, 4, SIGKILL));
  EXPECT_EQ(folder_.Read("run/trajectory.txt"), before);
  EXPECT_EQ(Summary("run")["complete"], true);
  EXPECT_EQ(Run("run", "--overwrite --max_depth=0.5").exit_code, 2);
  EXPECT_EQ(folder_.Read("run/trajectory.txt"), before);
  EXPECT_EQ(Run("run", other).exit_code, 0);
  EXPECT_EQ(Summary("run")["frames"], 20);
}

TEST_F(Resume, AFailureStaysAFailure) {
  const std::string nothing = "--max_depth=0.5";
  for (int i = 0; i < 2; ++i) {
    const ProgramResult result = Run("run", nothing);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr("nothing to reconstruct"));
    EXPECT_EQ(Summary("run")["complete"], false);
    EXPECT_EQ(Summary("run")["status"], "failed");
    EXPECT_THAT(Summary("run")["error"].get<std::string>(),
                HasSubstr("nothing to reconstruct"));
  }
}

TEST_F(Resume, TwoRunsDoNotMix) {
  RunningProgram first("sf_run", Arguments("run", kOptions));
  while (first.Runs() && FramesBegun("run") < 1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const ProgramResult second = Run("run", "--overwrite --max_frames=3");
  if (first.Runs()) {
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_THAT(second.errors, HasSubstr("is held by process"));
  }
  EXPECT_EQ(first.Wait().exit_code, 0);
  EXPECT_EQ(Summary("run")["frames"], 24);
}

TEST_F(Resume, AFolderThatIsRemovedMidwayIsNotMadeAgain) {
  RunningProgram program("sf_run", Arguments("run", kOptions));
  while (program.Runs() && FramesBegun("run") < 2) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(program.Runs());
  fs::rename(folder_ / "run", folder_ / "moved");
  const ProgramResult result = program.Wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("was removed or taken over"));
  EXPECT_FALSE(folder_.Has("run"));
}

TEST_F(Resume, ACheckpointThatIsDamagedIsNotTrusted) {
  ASSERT_EQ(Run("whole", kOptions).exit_code, 0);
  ASSERT_TRUE(Stop("run", kOptions, 12, SIGKILL));
  std::string state = folder_.Read("run/unfinished/checkpoint.bin");
  ASSERT_GT(state.size(), 1000u);
  state[state.size() / 2] ^= 1;
  folder_.Write("run/unfinished/checkpoint.bin", state);
  const ProgramResult result = Run("run", kOptions);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.errors, HasSubstr("begins anew"));
  ExpectSameResult("whole", "run");
}

TEST_F(Resume, AFolderOfTemporaryFilesThatIsGoneDoesNotCostTheCheckpoint) {
  ASSERT_EQ(Run("whole", kOptions).exit_code, 0);
  ASSERT_TRUE(Stop("run", kOptions, 12, SIGKILL));
  const std::string state = folder_.Read("run/unfinished/checkpoint.bin");
  const ProgramResult result = RunProgram("sf_run", Arguments("run", kOptions),
                                          "TMPDIR=" + (folder_ / "missing"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("expected a folder for temporary"));
  EXPECT_EQ(folder_.Read("run/unfinished/checkpoint.bin"), state);
  EXPECT_EQ(
      RunProgram("sf_run", Arguments("run", kOptions), "TMPDIR=").exit_code,
      0);  // As if it were unset.
  ExpectSameResult("whole", "run");
}

TEST_F(Resume, FilesThatAreGoneSinceTheCheckpointAreMadeAgain) {
  ASSERT_EQ(Run("whole", kOptions).exit_code, 0);
  for (const std::string folder : {"masks", "pictures"}) {
    ASSERT_TRUE(Stop(folder, kOptions, 12, SIGKILL));
    fs::remove_all(folder_ / (folder + "/unfinished/" + folder));
    const ProgramResult result = Run(folder, kOptions);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.errors, HasSubstr("begins anew: "));
    ExpectSameResult("whole", folder);
  }
}

TEST_F(Resume, DamagedResultsAreNotEvaluated) {
  ASSERT_EQ(Run("run", kOptions).exit_code, 0);
  const std::string evaluate = "--samples=500 --run=" + (folder_ / "run") +
                               " --ground_truth=" + (folder_ / "sequence");
  ASSERT_EQ(RunProgram("sf_evaluate", evaluate).exit_code, 0);
  ASSERT_EQ(RunProgram("sf_evaluate", evaluate).exit_code, 0);
  for (const std::string file :
       {"run/surfaces/001_person/motions.bin", "run/frames.jsonl",
        "run/surfaces/001_person/tsdf.vdb",
        "run/surfaces/000_background/mesh.ply"}) {
    const std::string text = folder_.Read(file);
    std::string damaged = text;
    damaged[damaged.size() / 2] ^= 4;
    folder_.Write(file, damaged);
    const ProgramResult result = RunProgram("sf_evaluate", evaluate);
    EXPECT_EQ(result.exit_code, 2) << file;
    EXPECT_THAT(result.errors, HasSubstr(fs::path(file).filename().string()));
    fs::remove(folder_ / file);
    EXPECT_EQ(RunProgram("sf_evaluate", evaluate).exit_code, 2) << file;
    folder_.Write(file, text);
  }
}

TEST_F(Resume, SetChangesOneNumberAndIsResolved) {
  const ProgramResult printed = RunProgram(
      "sf_run", Arguments("none",
                          "--print_identity \"--set=terms.arap.weight="
                          "4; object_voxel=0.006\""));
  ASSERT_EQ(printed.exit_code, 0) << printed.errors;
  const Json identity = Json::parse(printed.output);
  EXPECT_EQ(identity["identity_parts"]["terms.arap.weight"], "4");
  EXPECT_EQ(identity["identity_parts"]["object_voxel"], "0.006");
  EXPECT_EQ(identity["defaults"]["terms.arap.weight"], "8");
  EXPECT_EQ(identity["defaults"]["object_voxel"], "0.005");
  EXPECT_FALSE(identity["defaults"].contains("background_voxel"));
  // Where something is, and what is kept, do not decide the result.
  for (const char* flag : {"output", "sequence", "threads", "from",
                           "keep_checkpoints", "warped_every"}) {
    EXPECT_FALSE(identity["identity_parts"].contains(flag)) << flag;
  }
  EXPECT_TRUE(identity["outputs"].contains("keep_checkpoints"));
  EXPECT_FALSE(folder_.Has("none"));
  for (const auto& [set, part] :
       std::vector<std::pair<std::string, std::string>>{
           {"terms.nosuch.weight=4", "nosuch"},
           {"person.terms.nosuch.weight=4", "nosuch"},
           {"person.arap.weight=4", "CLASS.terms.NAME.KEY"},
           {"terms.arap.colour=4", "colour"},
           {"terms.arap.weight=heavy", "heavy"},
           {"nosuch=1", "nosuch"},
           {"output=there", "expected as a flag, --output"},
           {"max_nodes=many", "many"},
           {"max_nodes", "KEY=VALUE"}}) {
    const ProgramResult result =
        RunProgram("sf_run", Arguments("none", "\"--set=" + set + "\""));
    EXPECT_EQ(result.exit_code, 2) << set;
    EXPECT_THAT(result.errors, HasSubstr(part));
  }
}

TEST_F(Resume, SettingsAreGivenOnce) {
  const ProgramResult result = RunProgram(
      "sf_run", Arguments("none", "--set=max_frames=1 -set max_nodes=9"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.errors, HasSubstr("--set is given 2 times: expected all"));
}

TEST_F(Resume, OptionsRepeatTheRunFromAnotherFolder) {
  fs::create_directory(folder_ / "elsewhere");
  const std::string program = (ProgramFolder() / "sf_run").string();
  const auto run_in = [&](const std::string& folder, const std::string& flags) {
    return RunProgram("/bin/sh", "-c 'cd " + (folder_ / folder) + " && " +
                                     program + " " + flags + "'");
  };
  const ProgramResult first =
      run_in("", "--sequence=sequence --output=first --max_frames=2");
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  const ProgramResult again = run_in(
      "elsewhere", "--flagfile=../first/options.flags --output=../first");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_THAT(again.output, HasSubstr("nothing to do"));
}

TEST_F(Resume, OptionsOfAClassAreAPartOfTheRun) {
  const std::string options =
      std::string(kOptions) +
      " \"--set=person.terms.arap.weight=2; dog.terms.arap.weight=3\"";
  const ProgramResult whole = Run("whole", options);
  ASSERT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_THAT(whole.errors,
              HasSubstr("terms of class dog had no effect: there are surfaces "
                        "of background"));
  EXPECT_THAT(folder_.Read("whole/options.flags"),
              HasSubstr(" dog.arap(weight=3) person.arap(weight=2)\n"));
  ASSERT_TRUE(Stop("run", options, 8, SIGKILL));
  ASSERT_EQ(Run("run", options).exit_code, 0);
  ExpectSameResult("whole", "run");
  const ProgramResult again =
      RunProgram("sf_run", "--flagfile=" + (folder_ / "whole/options.flags") +
                               " --output=" + (folder_ / "whole"));
  EXPECT_THAT(again.output, HasSubstr("nothing to do"));
  const ProgramResult other = Run("run", kOptions);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.errors, HasSubstr("person.terms.arap.weight 2 -> "));
  ASSERT_EQ(Run("plain", kOptions).exit_code, 0);
  EXPECT_NE(folder_.Read("plain/surfaces/001_person/motions.bin"),
            folder_.Read("whole/surfaces/001_person/motions.bin"));
}

TEST_F(Resume, ATermWithoutResidualsIsNamed) {
  // It needs three frames.
  const std::string silent = "had no effect: it added no residuals";
  const ProgramResult run =
      Run("run", std::string(kOptions) +
                     " --set=terms.acceleration.weight=1 --max_frames=2");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("term acceleration " + silent));
  EXPECT_THAT(run.errors, Not(HasSubstr("term arap " + silent)));
}

TEST_F(Resume, OneStateCanBeGoneOnFromWithOtherTerms) {
  ASSERT_EQ(
      Run("base", std::string(kOptions) + " --keep_checkpoints").exit_code, 0);
  const std::string from = std::string(kOptions) + " --at=12 --from=";
  const ProgramResult same = Run("same", from + (folder_ / "base"));
  ASSERT_EQ(same.exit_code, 0) << same.errors;
  const std::string whole = folder_.Read("base/trajectory.txt");
  const std::string rest = folder_.Read("same/trajectory.txt");
  const std::string poses = rest.substr(rest.rfind('#'));
  EXPECT_EQ(std::count(rest.begin(), rest.end(), '\n') -
                std::count(whole.begin(), whole.end(), '\n'),
            -12);
  EXPECT_THAT(whole, HasSubstr(poses.substr(poses.find('\n') + 1)));
  EXPECT_EQ(folder_.Read("same/surfaces/001_person/motions.bin"),
            folder_.Read("base/surfaces/001_person/motions.bin"));
  const ProgramResult other =
      Run("other", from + (folder_ / "base") + " --set=terms.arap.weight=2");
  ASSERT_EQ(other.exit_code, 0) << other.errors;
  EXPECT_NE(folder_.Read("other/surfaces/001_person/motions.bin"),
            folder_.Read("base/surfaces/001_person/motions.bin"));
  EXPECT_EQ(
      RunProgram("sf_evaluate", "--samples=500 --run=" + (folder_ / "other") +
                                    " --ground_truth=" + (folder_ / "sequence"))
          .exit_code,
      0);
  const ProgramResult none = Run(
      "none", std::string(kOptions) + " --at=13 --from=" + (folder_ / "base"));
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.errors, HasSubstr("checkpoints/000013.bin"));
  const ProgramResult beyond =
      Run("none", from + (folder_ / "base") + " --max_frames=12");
  EXPECT_NE(beyond.exit_code, 0);
  EXPECT_THAT(beyond.errors, HasSubstr("is that after 12 frames of this run: "
                                       "expected one before the last of 12"));
  const ProgramResult alone = Run("none", "--at=12");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.errors, HasSubstr("at = 12: expected --from"));
  // Other images of the same size.
  std::string image;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder_ / "sequence/rgb")) {
    image = std::max(image, entry.path().string());
  }
  std::ofstream(image, std::ios::app) << "x";
  const ProgramResult differs = Run("none", from + (folder_ / "base"));
  EXPECT_EQ(differs.exit_code, 2);
  EXPECT_THAT(differs.errors, HasSubstr("input.frames differs"));
  EXPECT_FALSE(folder_.Has("none/run.json"));
}

TEST_F(Resume, TheIdentityIsOfContentsNotOfNames) {
  const auto identity = [&](const std::string& sequence) {
    const ProgramResult result = RunProgram(
        "sf_run", "--print_identity --sequence=" + (folder_ / sequence) +
                      " --output=" + (folder_ / "none"));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.output;
  };
  const std::string before = identity("sequence");
  fs::copy(folder_ / "sequence", folder_ / "copy", fs::copy_options::recursive);
  EXPECT_EQ(identity("copy"), before);
  for (const auto& entry :
       fs::directory_iterator(folder_ / "copy/masks_noisy")) {
    if (entry.path().extension() != ".json") continue;
    std::ofstream(entry.path(), std::ios::app) << "\n";
    break;
  }
  EXPECT_NE(identity("copy"), before);
}

}  // namespace
}  // namespace splitfusion
