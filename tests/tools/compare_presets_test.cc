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
using ::testing::HasSubstr;

// Two runs: one with every figure, one that failed with commas in its message.
constexpr const char* kFakeBatch = R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in --output=*) output="${argument#*=}" ;; esac
done
echo "$@" > "$output/arguments.txt"
mkdir -p "$output/room/splitfusion/pictures" "$output/room/cofusion/pictures"
touch "$output/room/splitfusion/pictures/000010_composite.png"
touch "$output/room/cofusion/pictures/000010_composite.png"
cat > "$output/summary.csv" <<END
sequence,options,error,ate_rmse_m,background_accuracy_m,background_completeness,objects_view_m,objects_right,objects_uncovered,objects_accuracy_m,objects_f_score,track_median_m,track_mean_m,seconds_median
room,splitfusion,,0.0125,0.004,0.75,0.005,0.5,0.25,0.006,0.625,0.007,0.008,1
room,cofusion,"no, none",,,,,,,,,,,
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
  EXPECT_EQ(Run((folder_ / "room") + " --max_frames=9 --output=" + out), 3);
  const std::string said = folder_.Read("said.txt");
  EXPECT_THAT(
      said, HasSubstr("| room | `splitfusion` | 12.5 | 4.0 | 75.0 % | "
                      "50.0 % | 5.0 | 25.0 % | 6.0 | 62.5 % | 7.0 | 8.0 |\n"));
  EXPECT_THAT(said, HasSubstr("| room | `cofusion` | - | - | - | - | "
                              "- | - | - | - | - | - |\n"));
  EXPECT_THAT(
      folder_.Read("out/arguments.txt"),
      HasSubstr("kinectfusion.flags," + out + "/options/dynamicfusion.flags," +
                out + "/options/cofusion.flags," + out +
                "/options/background_only.flags," + out +
                "/options/splitfusion.flags"));
  EXPECT_EQ(folder_.Read("out/options/cofusion.flags"),
            "--preset=cofusion\n--max_frames=9\n");
  const std::string run = out + "/room/";
  EXPECT_EQ(folder_.Read("out/room/pictures/000010_composite.jpg"),
            "input:" + run +
                "splitfusion/pictures/000010_input.png,cofusion:" + run +
                "cofusion/pictures/000010_composite.png,splitfusion:" + run +
                "splitfusion/pictures/000010_composite.png\n");
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

TEST_F(ComparePresets, AWrongFlagEndsItBeforeAnyRun) {
  Program("sf_run",
          "#!/bin/sh\necho noise >&2\necho 'sf_run: --n = 1: no' >&2\nexit 2");
  EXPECT_EQ(Run((folder_ / "room") + " --n=1 --output=" + (folder_ / "out")),
            2);
  EXPECT_EQ(folder_.Read("said.txt"),
            "compare_presets.sh: sf_run: --n = 1: no\n");
  EXPECT_FALSE(folder_.Has("out/arguments.txt"));
  // That its stand-in for a sequence is missing is right.
  Program("sf_run", R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in --sequence=*) sequence="${argument#*=}" ;; esac
done
echo "sf_run: $sequence: no such folder: expected a sequence" >&2
exit 2
)");
  EXPECT_EQ(Run((folder_ / "room") + " --n=1 --output=" + (folder_ / "out")),
            3);
  EXPECT_TRUE(folder_.Has("out/arguments.txt"));
}

TEST_F(ComparePresets, IsNoTableWhereEveryRunFailed) {
  Program("sf_batch", R"(#!/bin/sh
for argument in "$@"; do
  case "$argument" in --output=*) output="${argument#*=}" ;; esac
done
printf 'sequence,error,ate_rmse_m\nroom,no masks,\nroom,"no, none",\n' \
    > "$output/summary.csv"
exit 3
)");
  EXPECT_EQ(Run((folder_ / "room") + " --output=" + (folder_ / "out")), 3);
  EXPECT_EQ(folder_.Read("said.txt"),
            "compare_presets.sh: every run failed; see " + (folder_ / "out") +
                "/summary.csv and the *.err.log files beside\n");
}

}  // namespace
}  // namespace splitfusion
