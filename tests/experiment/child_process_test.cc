#include "splitfusion/lib/experiment/child_process.h"

#include <gtest/gtest.h>

#include "support/stub_programs.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class ChildProcessTest : public testing::Test {
 protected:
  ChildResult Run(const std::string& script, const ChildLimits& limits = {}) {
    return RunChild({WriteScript(folder_, "script", "#!/bin/sh\n" + script)},
                    folder_ / "said", {}, limits);
  }
  TemporaryFolder folder_;
};

TEST_F(ChildProcessTest, KeepsTheLastLinesAndTheLastVersionOfAProgressLine) {
  const ChildResult result =
      Run("echo a; echo b >&2; printf 'frame 1\\rframe 2\\n\\n' >&2; exit 4\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.last_lines, (std::vector<std::string>{"b", "frame 2"}));
  EXPECT_EQ(folder_.Read("said.log"), "a\n");
  EXPECT_GT(result.peak_memory_bytes, 0);
}

TEST_F(ChildProcessTest, SaysWhatEndedIt) {
  EXPECT_EQ(Run("kill -SEGV $$").LastLine(), "ended by signal 11");
  const ChildResult none = RunChild({folder_ / "none"}, folder_ / "said");
  EXPECT_EQ(none.exit_code, 127);
  EXPECT_NE(none.LastLine().find("none: No such file"), std::string::npos);
}

TEST_F(ChildProcessTest, IsKilledBeyondItsLimits) {
  ChildLimits limits;
  limits.wall_seconds = 0.1;
  ChildResult result = Run("exec sleep 100", limits);
  EXPECT_EQ(result.exit_code, 128 + 9);
  EXPECT_NE(result.LastLine().find("minutes"), std::string::npos);
  limits = {};
  limits.cpu_seconds = 0.1;
  result = Run("while :; do :; done", limits);
  EXPECT_EQ(result.exit_code, 128 + 9);
  EXPECT_NE(result.LastLine().find("CPU minutes"), std::string::npos);
  EXPECT_GT(result.cpu_seconds, 0.05);
  limits = {};
  limits.memory_bytes = 50'000'000;
  result = Run("exec tail /dev/zero", limits);
  EXPECT_EQ(result.exit_code, 128 + 9);
  EXPECT_NE(result.LastLine().find("GB of memory"), std::string::npos);
}

TEST_F(ChildProcessTest, IsAskedToStopAndThenKilled) {
  const std::string script =
      WriteScript(folder_, "script",
                  "#!/bin/sh\ntrap 'touch \"$0.asked\"' INT\ntouch \"$0.on\"\n"
                  "while :; do sleep 0.02; done\n");
  const ChildResult result = RunChild({script}, folder_ / "said", [&] {
    if (folder_.Has("script.asked")) return Stop::kAtOnce;
    return folder_.Has("script.on") ? Stop::kWhenReady : Stop::kNo;
  });
  EXPECT_EQ(result.exit_code, 128 + 9);
}

}  // namespace
}  // namespace splitfusion
