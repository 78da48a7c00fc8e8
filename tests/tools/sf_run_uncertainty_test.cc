// sf_run --covariance and sf_evaluate --calibration.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "support/expect_refused.h"
#include "tools/sf_run_fixture.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class SfRunUncertainty : public SfRun {
 protected:
  void RunWith(const std::string& output, const std::string& flags) const {
    const ProgramResult result =
        Run(output, "--pictures_every=0 --warped_every=0 " + flags);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  ProgramResult Calibrate(const std::string& run,
                          const std::string& arguments = "") const {
    return RunProgram("sf_evaluate",
                      "--run=" + (folder_ / run) +
                          " --ground_truth=" + (folder_ / "sequence") +
                          " --calibration=" + (folder_ / "calibration") + " " +
                          arguments);
  }
};

TEST_F(SfRunUncertainty, VerticesHaveTheirDeviationsAndMotionsStayTheSame) {
  Synthesize();
  RunWith("plain", "");
  RunWith("run", "--covariance=2");
  EXPECT_FALSE(folder_.Has("plain/uncertainty"));
  for (const char* file : {"trajectory.txt", "surfaces/001_person/motions.bin",
                           "surfaces/001_person/mesh.ply"}) {
    EXPECT_TRUE(folder_.Read(std::string("run/") + file) ==
                folder_.Read(std::string("plain/") + file))
        << file;
  }
  // Frame 0 has no model, 1 and 3 are not asked for.
  EXPECT_FALSE(folder_.Has("run/uncertainty/000001_001.ply"));
  EXPECT_FALSE(folder_.Has("run/uncertainty/000002_000.ply"));
  PlyProperties properties;
  const TriangleMesh mesh =
      ReadPly(folder_ / "run/uncertainty/000002_001.ply", &properties);
  ASSERT_EQ(properties["sigma"].size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    double squares = 0, weakest = 0;
    for (const std::string axis : {"x", "y", "z"}) {
      squares += std::pow(properties["sigma_" + axis][i], 2);
      weakest += std::pow(properties["weakest_" + axis][i], 2);
    }
    EXPECT_NEAR(properties["sigma"][i], std::sqrt(squares / 3), 1e-6);
    EXPECT_LE(weakest, squares * (1 + 1e-5));
    EXPECT_GE(weakest, squares / 3 * (1 - 1e-5));
    // From the noise of one pixel to what nothing holds.
    EXPECT_GT(properties["sigma"][i], 1e-5);
    EXPECT_LT(properties["sigma"][i], 1.0);
  }
}

TEST_F(SfRunUncertainty, TheReportSaysWhatThePriorHolds) {
  Synthesize();
  RunWith("run", "--covariance=2");
  std::istringstream lines(folder_.Read("run/frames.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    const Json frame = Json::parse(line);
    for (const Json& surface : frame["surfaces"]) {
      const bool told = frame["frame"] == 2 && surface["id"] == 1;
      ASSERT_EQ(surface.contains("hold"), told) << line;
      if (!told) continue;
      EXPECT_LT(surface["hold"]["held_by_prior"], surface["hold"]["nodes"]);
      EXPECT_GT(surface["hold"]["median_sigma"], 0.0);
    }
  }
  const Json summary = Json::parse(folder_.Read("run/summary.json"));
  EXPECT_TRUE(summary["surfaces"][1].contains("hold"));
}

TEST_F(SfRunUncertainty, IsComparedWithTrueMotions) {
  Synthesize("--frames=5");
  RunWith("run", "--covariance=1");
  const ProgramResult result = Calibrate("run");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("fitted scale: "));
  const Json json = Json::parse(folder_.Read("calibration.json"));
  EXPECT_GT(json["points"], 100);
  const double scale = json["fitted_scale"];
  EXPECT_GT(scale, 0.1);
  EXPECT_LT(scale, 10.0);
  EXPECT_THAT(folder_.Read("calibration.svg"), HasSubstr("<svg"));
  // With its own scale it is right.
  ASSERT_EQ(Calibrate("run", "--uncertainty_scale=" + std::to_string(scale))
                .exit_code,
            0);
  const Json own = Json::parse(folder_.Read("calibration.json"));
  double mean = 0;
  for (const Json& share : own["within_two"]) mean += double{share} / 3;
  EXPECT_NEAR(mean, 0.954, 0.01);
}

TEST_F(SfRunUncertainty, RefusesWhatCannotBe) {
  ExpectRefused("sf_run",
                "--covariance=-1 --sequence=none --output=" + (folder_ / "x"),
                "--covariance = -1: expected a number of frames, or 0");
  ExpectRefused("sf_evaluate", "--mesh=a.ply --calibration=x",
                "--calibration needs --run and --ground_truth");
  Synthesize();
  RunWith("plain", "");
  EXPECT_THAT(Calibrate("plain").errors, HasSubstr("no uncertainty/"));
}

}  // namespace
}  // namespace splitfusion
