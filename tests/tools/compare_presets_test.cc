// tools/compare_presets.sh with stand-ins for the programs it calls.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Two runs: one with every figure, one that failed.
constexpr const char* kFakeBatch = R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in --output=*) output="${argument#*=}" ;; esac
done
echo "$@" > "$output/arguments.txt"
for run in a b; do
  mkdir -p "$output/tasks/$run/run/pictures"
  touch "$output/tasks/$run/run/pictures/000010_composite.png"
done
cat > "$output/results.csv" <<END
task,sequence,repeat,status,preset,ate_m,tracks_mean_m,tracks_median_m,surface_error_m,f_score_seen,view_error_m,missing,stretched,ghosts
a,room,0,complete,splitfusion,0.0125,0.008,0.007,0.006,0.625,0.005,0.25,0.01,0.02
b,room,0,failed,cofusion,,,,,,,,,
END
exit 3
)";

constexpr const char* kFakeMontage = R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in
    --output=*) output="${argument#*=}" ;;
    --pictures=*) pictures="${argument#*=}" ;;
  esac
done
echo "$pictures" > "$output"
)";

class ComparePresets : public testing::Test {
 protected:
  void SetUp() override {
    script_ = (RepositoryRoot() / "tools/compare_presets.sh").string();
    if (!fs::exists(script_)) GTEST_SKIP() << "not built in the repository";
    Program("sf_run", "#!/bin/sh\n");
    Program("sf_evaluate", "#!/bin/sh\n");
    Program("sf_batch", kFakeBatch);
    Program("sf_montage", kFakeMontage);
    fs::create_directories(folder_ / "room");
  }

  void Program(const std::string& name, const std::string& text) {
    fs::permissions(folder_.Write("bin/" + name, text), fs::perms::owner_all);
  }

  /// Exit code; what it says is in said.txt.
  int Run(const std::string& arguments) {
    const std::string command = "SPLITFUSION_BIN='" + (folder_ / "bin") +
                                "' '" + script_ + "' " + arguments + " > '" +
                                (folder_ / "said.txt") + "' 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  TemporaryFolder folder_;
  std::string script_;
};

TEST_F(ComparePresets, PrintsTheFiguresOfEveryPreset) {
  const std::string out = folder_ / "out";
  EXPECT_EQ(
      Run((folder_ / "room") + " --max_frames=9 --full_report --output=" + out),
      3);
  const std::string said = folder_.Read("said.txt");
  EXPECT_THAT(said, HasSubstr("| room | `splitfusion` | 12.5 | 6.0 | 5.0 | "
                              "62.5 % | 25.0 % | 1.0 % | 2.0 % | 7.0 | 8.0 |"));
  EXPECT_THAT(said, HasSubstr("| room | `cofusion` | - | - | - | - | "
                              "- | - | - | - | - |\n"));
  EXPECT_THAT(
      folder_.Read("out/arguments.txt"),
      AllOf(HasSubstr("--grid=preset=kinectfusion,dynamicfusion,cofusion,"
                      "background_only,splitfusion "),
            HasSubstr("--set=max_frames=\"9\"; full_report=\"true\"; ")));
  const std::string tasks = out + "/tasks/";
  EXPECT_EQ(folder_.Read("out/pictures/room/000010_composite.jpg"),
            "input:" + tasks +
                "a/run/pictures/000010_input.png,cofusion:" + tasks +
                "b/run/pictures/000010_composite.png,splitfusion:" + tasks +
                "a/run/pictures/000010_composite.png\n");
}

TEST_F(ComparePresets, HelpIsItsLeadingComment) {
  EXPECT_EQ(Run("--help"), 0);
  const std::string said = folder_.Read("said.txt");
  EXPECT_THAT(said, testing::StartsWith("Runs every preset on every sequence"));
  EXPECT_THAT(said, testing::EndsWith("if not build/release/bin.\n"));
}

TEST_F(ComparePresets, SaysWhatIsMissing) {
  EXPECT_EQ(Run("--output=" + (folder_ / "out")), 2);
  EXPECT_THAT(folder_.Read("said.txt"), HasSubstr("folder of a sequence"));
  EXPECT_EQ(Run(folder_ / "room"), 2);
  EXPECT_THAT(folder_.Read("said.txt"), HasSubstr("expected --output=DIR"));
  fs::remove(folder_ / "bin/sf_montage");
  EXPECT_EQ(Run((folder_ / "room") + " --output=" + (folder_ / "out")), 2);
  EXPECT_THAT(folder_.Read("said.txt"), HasSubstr("sf_montage: not found"));
}

TEST_F(ComparePresets, AWrongFlagEndsIt) {
  Program(
      "sf_batch",
      "#!/bin/sh\necho noise >&2\necho 'sf_batch: --n = 1: no' >&2\nexit 2");
  EXPECT_EQ(Run((folder_ / "room") + " --n=1 --output=" + (folder_ / "out")),
            2);
  EXPECT_EQ(folder_.Read("said.txt"), "compare_presets.sh: --n = 1: no\n");
}

TEST_F(ComparePresets, IsNoTableWhereEveryRunFailed) {
  Program("sf_batch", R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in --output=*) output="${argument#*=}" ;; esac
done
printf 'sequence,status,ate_m\nroom,failed,\nroom,failed,\n' \
    > "$output/results.csv"
exit 3
)");
  EXPECT_EQ(Run((folder_ / "room") + " --output=" + (folder_ / "out")), 3);
  EXPECT_EQ(folder_.Read("said.txt"),
            "compare_presets.sh: every run failed; see sf_batch status "
            "--output=" +
                (folder_ / "out") + "\n");
}

}  // namespace
}  // namespace splitfusion
