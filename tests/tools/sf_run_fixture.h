#ifndef SPLITFUSION_TESTS_TOOLS_SF_RUN_FIXTURE_H_
#define SPLITFUSION_TESTS_TOOLS_SF_RUN_FIXTURE_H_

#include <gtest/gtest.h>

#include <string>

#include "support/program.h"
#include "support/temporary_folder.h"

namespace splitfusion {

/// Runs sf_run on a tiny synthetic sequence.
class SfRun : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"sf_synth", "sf_run", "sf_evaluate"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
  }

  /// A tiny sequence in the folder `sequence`; `arguments`: of sf_synth.
  void Synthesize(const std::string& arguments = "--frames=4") const {
    const ProgramResult result =
        RunProgram("sf_synth", "--width=160 --height=120 --output=" +
                                   (folder_ / "sequence") + " " + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  ProgramResult Run(const std::string& output,
                    const std::string& arguments = "") const {
    return RunProgram("sf_run", "--sequence=" + (folder_ / "sequence") +
                                    " --output=" + (folder_ / output) + " " +
                                    arguments);
  }

  TemporaryFolder folder_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_TOOLS_SF_RUN_FIXTURE_H_
