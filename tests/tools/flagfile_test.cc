// Flagfiles: what gflags would pass over in silence is an error of one line.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class Flagfile : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_synth")) GTEST_SKIP() << "sf_synth is not built";
  }

  std::string Arguments(const std::string& file) const {
    return "--width=64 --height=48 --track_points=0 --output=" +
           (folder_ / "sequence") + " --flagfile=" + file;
  }

  /// Expects that a flagfile of this text is refused, and nothing written.
  void Refuses(const std::string& text, const std::string& message) const {
    folder_.Write("my.flags", text);
    RefusesFile(folder_ / "my.flags", message);
  }

  void RefusesFile(const std::string& file, const std::string& message) const {
    ExpectRefused("sf_synth", Arguments(file), message);
    EXPECT_FALSE(folder_.Has("sequence")) << message;
  }

  TemporaryFolder folder_;
};

TEST_F(Flagfile, FlagsCommentsAndBlankLinesAreTaken) {
  folder_.Write("more.flags", "--frames=2\n");
  folder_.Write("my.flags",
                "# mine\n\n  -seed=3\n --nooverwrite\n--overwrite\n"
                "--flagfile=" +
                    (folder_ / "more.flags"));
  const ProgramResult result =
      RunProgram("sf_synth", Arguments(folder_ / "my.flags"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const std::string config = folder_.Read("sequence/gt/config.json");
  EXPECT_NE(config.find("\"frames\": 2"), std::string::npos) << config;
  EXPECT_NE(config.find("\"seed\": 3"), std::string::npos) << config;
}

TEST_F(Flagfile, LinesOfWindowsAreTaken) {
  folder_.Write("my.flags", "# mine\r\n\r\n--frames=1\r\n");
  const ProgramResult result =
      RunProgram("sf_synth", Arguments(folder_ / "my.flags"));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
}

TEST_F(Flagfile, LinesWithoutDashesAreRefused) {
  Refuses("my flags for today\n--frames=2\n",
          "my.flags, line 1: 'my flags for today': expected --flag=value, or # "
          "before a comment");
  Refuses("--frames=2\nframes=1\n", "my.flags, line 2: 'frames=1': expected");
  Refuses("frames = 1\n", "line 1: 'frames = 1': expected --flag=value");
  Refuses("sf_synth\n--frames=2\n", "line 1: 'sf_synth': expected");
}

TEST_F(Flagfile, LinesThatGflagsPassesOverAreRefused) {
  Refuses("--frames = 1\n", "line 1: expected --flag=value without blanks");
  Refuses("--frames 1\n", "line 1: expected --flag=value without blanks");
  Refuses("--frames\n", "line 1: flag without a value: expected --frames=VAL");
  Refuses("--noframes\n", "line 1: unknown flag 'noframes'");
  Refuses("---frames=1\n", "line 1: unknown flag '-frames'");
  Refuses("--\n", "line 1: unknown flag ''");
  Refuses("--frames=many\n", "illegal value 'many'");
}

TEST_F(Flagfile, BytesAreRefusedAndNotPrinted) {
  Refuses(std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16),
          "my.flags, line 1: '\\x89PNG\\x0d': expected");
  Refuses("--frames=1\x1b[2J\n", "line 1: '--frames=1\\x1b[2J': expected");
  Refuses(std::string(5000000, 'x'), "xxx...': expected --flag=value");
}

TEST_F(Flagfile, OtherThanFilesAreRefused) {
  RefusesFile(folder_ / "none", "none': no such file");
  RefusesFile(folder_ / "", "': expected a regular file, one flag a line");
  RefusesFile("/dev/zero", "'/dev/zero': expected a regular file");
}

TEST_F(Flagfile, OnesThatNameThemselvesAreRefused) {
  Refuses("--flagfile=" + (folder_ / "my.flags"), "my.flags': names itself");
  folder_.Write("b.flags", "--frames=1\n--flagfile=" + (folder_ / "my.flags"));
  Refuses("--flagfile=" + (folder_ / "b.flags"), "my.flags': names itself");
}

TEST_F(Flagfile, NamedOnesAreCheckedToo) {
  folder_.Write("b.flags", "frames=1\n");
  Refuses("--flagfile=" + (folder_ / "b.flags"), "b.flags, line 1: 'frames=1'");
}

}  // namespace
}  // namespace splitfusion
