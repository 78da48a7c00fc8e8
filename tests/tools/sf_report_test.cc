// The program sf_report, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sf_run_fixture.h"
#include "support/expect_refused.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SfReport : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (!HasProgram("sf_report")) GTEST_SKIP() << "sf_report is not built";
  }

  void MakeRun(const std::string& name) const {
    const ProgramResult result =
        Run(name, "--max_frames=4 --pictures_every=2 --warped_every=0");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  ProgramResult Report(const std::string& arguments) const {
    return RunProgram("sf_report", arguments);
  }
};

TEST_F(SfReport, OfOneRunIsItsOwnPage) {
  Synthesize("--frames=4");
  MakeRun("run");
  const ProgramResult result =
      Report((folder_ / "run") + "/ --output=" + (folder_ / "page.html"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string page = folder_.Read("page.html");
  EXPECT_EQ(page, folder_.Read("run/report.html"));
  EXPECT_THAT(page, HasSubstr("<h2>run</h2>"));
  EXPECT_THAT(page, HasSubstr("background_voxel"));
  EXPECT_THAT(page, HasSubstr("alt=\"frame 2\" src=\"data:image/jpeg"));
  EXPECT_THAT(page, HasSubstr("projective_depth"));
}

TEST_F(SfReport, OfTwoRunsComparesThemAndWritesFigures) {
  Synthesize("--frames=4");
  MakeRun("run");
  std::filesystem::create_directories(folder_ / "other");
  std::filesystem::copy(folder_ / "run", folder_ / "other/run",
                        std::filesystem::copy_options::recursive);
  const ProgramResult result =
      Report((folder_ / "run") + " " + (folder_ / "other/run") + " --output=" +
             (folder_ / "page.html") + " --figures=" + (folder_ / "figures"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(folder_.Read("page.html"), HasSubstr("<h2>Runs</h2>"));
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder_ / "figures")) {
    ++files;
    EXPECT_EQ(entry.path().extension(), ".svg");
  }
  // Two runs of the same name are told apart.
  EXPECT_THAT(result.output, HasSubstr(std::to_string(files) + " figures"));
  EXPECT_GT(files, 2 * (1 + 7));
}

TEST_F(SfReport, PlaysSurfacesOnlyWhereTheyAreAskedFor) {
  Synthesize("--frames=4");
  MakeRun("run");
  const auto size = [&](const std::string& media) {
    EXPECT_EQ(Report((folder_ / "run") + " --media=" + media +
                     " --output=" + (folder_ / "page.html"))
                  .exit_code,
              0);
    return folder_.Read("page.html").size();
  };
  const std::size_t none = size("none");
  EXPECT_THAT(folder_.Read("page.html"), Not(HasSubstr("data:image")));
  EXPECT_GT(size("all"), none);
}

TEST_F(SfReport, PlaysFewerFramesOfWhatIsTooMuchForAPage) {
  Synthesize("--frames=4");
  MakeRun("run");
  const std::string command =
      (folder_ / "run") + " --output=" + (folder_ / "page.html");
  ASSERT_EQ(Report(command).exit_code, 0);
  const std::string page = folder_.Read("page.html");
  if (page.find("class=\"scene\"") == std::string::npos) {
    GTEST_SKIP() << "node not found when this was built: no viewer";
  }
  EXPECT_THAT(page, HasSubstr(R"({"frames":[0,1,2,3],"poses")"));
  auto summary = nlohmann::json::parse(folder_.Read("run/summary.json"));
  summary["surfaces"][0]["nodes"] = 1'000'000;  // Two million in four frames.
  folder_.Write("run/summary.json", summary.dump());
  ASSERT_EQ(Report(command).exit_code, 0);
  EXPECT_THAT(folder_.Read("page.html"),
              HasSubstr(R"({"frames":[0,3],"poses")"));
}

TEST_F(SfReport, ShowsTheFiguresOfSolvers) {
  folder_.Write("solved/solvers.csv", "problem\n");
  folder_.Write("solved/profile.svg", "<svg><text>a profile</text></svg>");
  const std::string command =
      (folder_ / "solved") + " --output=" + (folder_ / "page.html");
  ASSERT_EQ(Report(command).exit_code, 0);
  EXPECT_THAT(folder_.Read("page.html"), HasSubstr("a profile"));
  folder_.Write("solved/profile.svg", "<script>");
  ExpectRefused("sf_report", command, "profile.svg");
}

TEST_F(SfReport, SaysWhatIsWrong) {
  const std::string page = " --output=" + (folder_ / "page.html");
  ExpectRefused("sf_report", page, "RUN");
  ExpectRefused("sf_report", folder_ / "nothing", "output");
  ExpectRefused("sf_report", (folder_ / "nothing") + page,
                "nothing/summary.json");
  ExpectRefused("sf_report", (folder_ / "nothing") + page + " --media=some",
                "media");
  ExpectRefused("sf_report",
                (folder_ / "nothing") + page + " --figure_format=png",
                "figure_format");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "page.html"));
}

}  // namespace
}  // namespace splitfusion
