// Terms of a library that end a run of sf_run: it names the term, and what was
// computed before is kept.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "support/environment.h"
#include "support/repository.h"
#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class HostileRuns : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (!HasProgram("hostile_terms.so")) {
      GTEST_SKIP() << "hostile_terms.so is not built";
    }
    if (!IsSkipped()) Synthesize("--frames=3");
  }

  /// A run with the hostile term, which does `way` at `at` from frame 1 on.
  ProgramResult RunHostile(const std::string& output, const std::string& way,
                           const std::string& at,
                           const std::string& flags = "") const {
    const Environment environment(
        {{"HOSTILE_WAY", way}, {"HOSTILE_AT", at}, {"HOSTILE_FRAME", "1"}});
    return Run(output, "--terms_library=" +
                           (ProgramFolder() / "hostile_terms.so").string() +
                           " --set=terms.hostile.weight=1 --pictures_every=0"
                           " --write_masks=false --checkpoint_every=1 " +
                           flags);
  }
};

TEST_F(HostileRuns, ExceptionsKeepTheFramesBefore) {
  for (const auto& [way, at, code, what] :
       std::vector<std::tuple<std::string, std::string, int, std::string>>{
           {"throw_input_error", "AddResiduals", 2, "a.csv: gone"},
           {"throw_number", "evaluating", 1, "threw what is no std::exception"},
           {"throw", "Prepare", 1, "gone"},
           {"throw_number", "Save", 1, "threw what is no std::exception"}}) {
    SCOPED_TRACE(way + " at " + at);
    const ProgramResult result = RunHostile("run", way, at, "--overwrite");
    const std::string message = "term 'hostile', " + at +
                                (at == "evaluating" ? "" : "()") + ": " + what;
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.errors, HasSubstr(message));
    const Json marker = Json::parse(folder_.Read("run/run.json"));
    EXPECT_EQ(marker.at("status"), "failed");
    EXPECT_EQ(marker.at("error"), message);
    const std::string frames = folder_.Read("run/frames.jsonl");
    EXPECT_GE(std::count(frames.begin(), frames.end(), '\n'), 1);
  }
}

TEST_F(HostileRuns, ValuesThatAreNoneLoseSurfacesAndEndNoRun) {
  const ProgramResult result =
      RunHostile("run", "nan", "evaluating", "--max_lost=1");
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  // The models are not to blame.
  EXPECT_THAT(folder_.Read("run/frames.jsonl"),
              Not(HasSubstr("\"event\":\"reanchored\"")));
  EXPECT_THAT(folder_.Read("run/frames.jsonl"),
              HasSubstr("solver: The cost of term 'hostile' is not finite."));
  const Json marker = Json::parse(folder_.Read("run/run.json"));
  EXPECT_EQ(marker.at("status"), "complete");
}

TEST_F(HostileRuns, EndsFromWithinNameTheTermAndAreGoneOnFrom) {
  const std::string term = "sf_run: term 'hostile', ";
  const auto expect = [&](const std::string& output, const std::string& way,
                          const std::string& at, const std::string& message) {
    SCOPED_TRACE(way + " at " + at);
    const ProgramResult result = RunHostile(output, way, at);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_NE(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr(message));
    EXPECT_FALSE(folder_.Has(output + "/run.json"));
  };
  expect("exit", "exit", "evaluating", term + "evaluating: has called exit()");
  expect("terminate", "throw_where_none_may", "evaluating",
         "sf_run: failed: term 'hostile', evaluating: gone");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  expect("segv", "segv", "AddResiduals", term + "AddResiduals(): SIGSEGV");
  expect("fpe", "fpe", "evaluating", term + "evaluating: SIGFPE");
  expect("abort", "abort", "Prepare", term + "Prepare(): SIGABRT");
#endif
  const ProgramResult again = RunHostile("exit", "", "");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_THAT(again.errors, HasSubstr("goes on after 1 of 3 frames"));
  const Json marker = Json::parse(folder_.Read("exit/run.json"));
  EXPECT_EQ(marker.at("status"), "complete");
  EXPECT_EQ(marker.at("resumed_at"), Json::array({1}));
}

}  // namespace
}  // namespace splitfusion
