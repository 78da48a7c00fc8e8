// Programs whose listeners have gone: closed streams, pipes, limits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "support/program.h"
#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class StandardStreams : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"sf_synth", "sf_run"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
    ASSERT_EQ(
        RunProgram("sf_synth", "--width=160 --height=120 --frames=2 --output=" +
                                   (folder_ / "sequence"))
            .exit_code,
        0);
  }

  /// Exit code of sf_run within a command of bash: `before` it, `after` it.
  int Run(const std::string& before, const std::string& after) const {
    const std::string command =
        before + " " + (ProgramFolder() / "sf_run").string() +
        " --pictures_every=0 --sequence=" + (folder_ / "sequence") +
        " --output=" + (folder_ / "run") + " " + after;
    const int status =
        std::system(("bash -c '" + command + "' >" + (folder_ / "out") + " 2>" +
                     (folder_ / "err"))
                        .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  TemporaryFolder folder_;
};

TEST_F(StandardStreams, AReaderThatHasGoneDoesNotEndTheRun) {
  // No masks: there is a warning to say.
  fs::remove_all(folder_ / "sequence/masks_noisy");
  EXPECT_EQ(Run("", "2>&1 | true; exit ${PIPESTATUS[0]}"), 0);
  EXPECT_TRUE(folder_.Has("run/summary.json"));
}

TEST_F(StandardStreams, ClosedOnesDoNotMixWithFiles) {
  fs::remove_all(folder_ / "sequence/masks_noisy");
  EXPECT_EQ(Run("", "0<&- 1>&- 2>&-"), 0);
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "run")) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), folder_ / "").string();
    EXPECT_THAT(folder_.Read(name), Not(HasSubstr("no masks found"))) << name;
  }
  const std::string frames = folder_.Read("run/frames.jsonl");
  EXPECT_EQ(frames.substr(0, 1), "{") << frames.substr(0, 80);
}

TEST_F(StandardStreams, ALimitOnFilesIsAnOrdinaryError) {
  EXPECT_EQ(Run("ulimit -f 20;", ""), 2);
  EXPECT_THAT(folder_.Read("err"), HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace splitfusion
