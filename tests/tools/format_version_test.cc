// Every JSON file that the programs write tells its version; older ones have
// none and are read, newer ones are refused by one line.

#include "splitfusion/lib/base/format_version.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class FormatVersion : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    for (const char* program : {"sf_report", "sf_refine"}) {
      if (!HasProgram(program)) GTEST_SKIP() << program << " is not built";
    }
    if (IsSkipped()) return;
    Synthesize("--frames=3");
    ASSERT_EQ(Run("run", "--pictures_every=0").exit_code, 0);
    ASSERT_EQ(Evaluate().exit_code, 0);
  }

  ProgramResult Evaluate() const {
    return RunProgram("sf_evaluate",
                      "--run=" + (folder_ / "run") +
                          " --ground_truth=" + (folder_ / "sequence"));
  }
  ProgramResult Report() const {
    return RunProgram("sf_report", (folder_ / "run") +
                                       " --output=" + (folder_ / "page.html"));
  }
  ProgramResult Refine() const {
    return RunProgram("sf_refine",
                      (folder_ / "run") + " --output=" + (folder_ / "refined"));
  }

  /// Gives a file of the run another version; 0: none.
  void SetVersion(const std::string& name, int version) const {
    Json json = Json::parse(folder_.Read("run/" + name));
    json["format_version"] = version;
    if (version == 0) json.erase("format_version");
    folder_.Write("run/" + name, json.dump());
  }

  /// Expects that a program refuses a file of the next version.
  void ExpectRefusal(const ProgramResult& result,
                     const std::string& name) const {
    SCOPED_TRACE(name);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1)
        << result.errors;
    EXPECT_THAT(result.errors, HasSubstr(name + ": field 'format_version': " +
                                         std::to_string(kFormatVersion + 1) +
                                         ": expected at most " +
                                         std::to_string(kFormatVersion)));
  }
};

TEST_F(FormatVersion, IsInEveryJsonFile) {
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "")) {
    const fs::path& path = entry.path();
    // Lists of detections have a form of others.
    const bool is_list = path.parent_path().filename() == "masks_noisy";
    if (path.extension() != ".json" || is_list) continue;
    SCOPED_TRACE(path);
    ++files;
    const std::string name = fs::relative(path, folder_ / "").string();
    const Json json = Json::parse(folder_.Read(name));
    ASSERT_FALSE(json.empty());
    EXPECT_EQ(json.value("format_version", 0), kFormatVersion);
  }
  // Marker, summary, evaluation and two graphs; marker and two of the truth.
  EXPECT_EQ(files, 8);
}

TEST_F(FormatVersion, NewerFilesAreRefusedByOneLine) {
  const int newer = kFormatVersion + 1;
  SetVersion("evaluation.json", newer);
  ExpectRefusal(Report(), "evaluation.json");
  SetVersion("evaluation.json", kFormatVersion);
  SetVersion("summary.json", newer);
  ExpectRefusal(Report(), "summary.json");
  SetVersion("summary.json", kFormatVersion);
  SetVersion("run.json", newer);
  ExpectRefusal(Report(), "run.json");
  ExpectRefusal(Evaluate(), "run.json");
  ExpectRefusal(Refine(), "run.json");
  fs::remove(folder_ / "run/run.json");
  SetVersion("surfaces/001_person/graph.json", newer);
  ExpectRefusal(Evaluate(), "graph.json");
}

TEST_F(FormatVersion, OlderFilesHaveNoneAndAreRead) {
  fs::remove(folder_ / "run/run.json");
  for (const char* name :
       {"summary.json", "evaluation.json", "surfaces/000_background/graph.json",
        "surfaces/001_person/graph.json"}) {
    SetVersion(name, 0);
  }
  for (const ProgramResult& result : {Report(), Evaluate()}) {
    EXPECT_EQ(result.exit_code, 0) << result.errors;
  }
}

}  // namespace
}  // namespace splitfusion
