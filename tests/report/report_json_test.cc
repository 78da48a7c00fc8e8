#include "splitfusion/lib/report/report_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/json_file.h"
#include "support/sample_report.h"

namespace splitfusion {
namespace {

nlohmann::json RoundTrip(const FrameReport& report) {
  return nlohmann::json::parse(JsonText(ToJson(report)));
}

TEST(ReportJson, HoldsTheFrame) {
  const auto json = RoundTrip(SampleReport(3));
  EXPECT_EQ(json["frame"], 3);
  EXPECT_EQ(json["timestamp"], 100.0 + 3 / 30.0);  // Exact, not rounded.
  EXPECT_EQ(json["stem"], "stem3");
  EXPECT_EQ(json["seconds"]["solve"], 0.2);
  EXPECT_EQ(json["seconds"]["total"], 0.5);
  EXPECT_EQ(json["decisions"][0]["action"], "matched");
  EXPECT_EQ(json["decisions"][0]["overlap"], 0.8);
}

TEST(ReportJson, HoldsSurfacesAndRounds) {
  const auto json = RoundTrip(SampleReport(0));
  ASSERT_EQ(json["surfaces"].size(), 2u);
  const auto& surface = json["surfaces"][1];
  EXPECT_EQ(surface["label"], "teddy bear");
  EXPECT_EQ(surface["kind"], "non_rigid");
  EXPECT_EQ(surface["nodes"], 120);
  EXPECT_EQ(surface["node_spacing"], 0.03);
  const auto& round = surface["rounds"][0];
  EXPECT_EQ(round["stage"], "rigid");
  EXPECT_EQ(round["association"]["accepted"], 1000);
  EXPECT_EQ(round["solver"]["iterations"], 2);
  EXPECT_EQ(round["solver"]["terms"][1]["term"], "arap");
  EXPECT_EQ(round["solver"]["terms"][1]["final"], 0.025);
}

TEST(ReportJson, HoldsTheUnknownsOfTermsIfThereAreSome) {
  FrameReport report = SampleReport(0);
  SolverReport& solver = report.surfaces[0].rounds[0].solver;
  EXPECT_FALSE(RoundTrip(report)["surfaces"][0]["rounds"][0]["solver"].contains(
      "unknowns"));
  solver.unknowns = {{"color", "offset", "grey value", 0, 0.125}};
  const auto json = RoundTrip(report);
  const auto& unknown =
      json["surfaces"][0]["rounds"][0]["solver"]["unknowns"][0];
  EXPECT_EQ(unknown["term"], "color");
  EXPECT_EQ(unknown["name"], "offset");
  EXPECT_EQ(unknown["unit"], "grey value");
  EXPECT_EQ(unknown["initial"], 0);
  EXPECT_EQ(unknown["final"], 0.125);
}

TEST(ReportJson, NumbersThatAreNoneBecomeNull) {
  FrameReport report = SampleReport(0);
  report.surfaces[0].residual_rms = std::numeric_limits<double>::quiet_NaN();
  report.surfaces[0].rounds[0].solver.final_cost =
      std::numeric_limits<double>::infinity();
  const auto json = RoundTrip(report);
  EXPECT_TRUE(json["surfaces"][0]["residual_rms"].is_null());
  EXPECT_TRUE(
      json["surfaces"][0]["rounds"][0]["solver"]["final_cost"].is_null());
}

TEST(ReportJson, IsOneLineWhateverTheTextsHold) {
  FrameReport report = SampleReport(0);
  report.surfaces[0].reason = "two\nlines \"quoted\" \xff";
  const std::string text = JsonText(ToJson(report));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(text)["surfaces"][0]["reason"],
            "two\nlines \"quoted\" \xEF\xBF\xBD");
}

}  // namespace
}  // namespace splitfusion
