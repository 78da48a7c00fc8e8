#include "splitfusion/lib/page/html_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/base/base64.h"
#include "splitfusion/lib/page/html_tables.h"
#include "splitfusion/lib/page/page_bundle.h"
#include "splitfusion/lib/page/svg_chart.h"
#include "splitfusion/lib/report/run_directory.h"
#include "support/expect_input_error.h"
#include "support/sample_report.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos;
       at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(SvgChart, ScalesToTheLargestValueAndBreaksAtGaps) {
  const std::string svg =
      SvgChart({"cost", {{"a", {1, NAN, 4, 2}}}, {}, false, {}});
  EXPECT_EQ(Count(svg, "<polyline"), 2u);
  EXPECT_TRUE(Contains(svg, ">4</text>"));
  EXPECT_FALSE(Contains(svg, "nan"));
  // From the upper end (4) to its half (2) at the right end; no way back.
  EXPECT_TRUE(Contains(svg, "points=\"437.3,24 628,92 628,92 \""));
}

TEST(SvgChart, StacksAreas) {
  const std::string svg =
      SvgChart({"time", {{"a", {1, 1}}, {"b", {2, NAN}}}, {}, true, {}});
  EXPECT_EQ(Count(svg, "<polygon"), 2u);
  EXPECT_TRUE(Contains(svg, ">3</text>"));  // 1 + 2.
}

TEST(SvgChart, CountsInFrames) {
  const std::string svg =
      SvgChart({"cost", {{"a", {1, 1, 1}}}, {1}, false, {100, 110, 200}});
  for (const char* tick : {">100</text>", ">120</text>", ">200</text>"}) {
    EXPECT_TRUE(Contains(svg, tick)) << tick;
  }
  EXPECT_FALSE(Contains(svg, ">0</text>\n<text x=\"56\""));
  // Frame 110 is a tenth of the way, 56 + 57.2.
  EXPECT_TRUE(Contains(svg, "M113.2 24v136"));
}

TEST(SvgChart, ALongLegendHasLines) {
  Chart chart{"points", {}, {}, false, {}};
  for (int k = 0; k < 12; ++k) {
    chart.series.push_back({"a reason of many words", {1, 2}});
  }
  const std::string svg = SvgChart(chart);
  EXPECT_TRUE(Contains(svg, "y=\"192\""));
  EXPECT_TRUE(Contains(svg, "y=\"208\""));
}

TEST(SvgChart, SaysWhenThereIsNothing) {
  EXPECT_TRUE(Contains(SvgChart({"cost", {}, {}, false, {}}), "no values"));
  EXPECT_TRUE(
      Contains(SvgChart({"cost", {{"a", {NAN}}}, {}, false, {}}), "no values"));
}

TEST(SvgStrips, AreOneBarForEqualValuesOnEnd) {
  const std::string svg = SvgStrips({{"001", {"", "up", "up", "down", "up"}}},
                                    {"up", "down"}, {0, 1, 2, 3, 4});
  const std::string marked =
      SvgStrips({{"001", {"up"}, {{0, "frame 0: a<b born"}}}}, {"up"}, {0});
  EXPECT_TRUE(Contains(marked, "<title>frame 0: a&lt;b born</title>"));
  // Three bars, and two in the legend.
  EXPECT_EQ(Count(svg, "<rect"), 5u);
  EXPECT_TRUE(Contains(svg, "<rect x=\"199\" y=\"4\" width=\"286\""));
}

/// Three frames, 10 to 12, with a surface that is lost in the second one.
class HtmlReportTest : public ::testing::Test {
 protected:
  HtmlReportTest() {
    RunDirectory run(folder_ / "run", {"cofusion", "", {}});
    for (int frame = 10; frame < 13; ++frame) {
      FrameReport report = SampleReport(frame);
      report.surfaces[1].label = "a<b>";
      if (frame == 11) report.surfaces[1].state = TrackState::kLost;
      if (frame == 12) {
        report.surfaces[1].rounds[0].solver.terms[0].final = NAN;
      }
      run.AddFrame(report, {});
    }
    std::filesystem::create_directories(folder_ / "run/pictures");
    cv::imwrite(folder_ / "run/pictures/000012_montage.png",
                cv::Mat(30, 40, CV_8UC3, cv::Scalar(10, 200, 30)));
    run.Finish({}, WriteHtmlReport);
  }

  const TemporaryFolder folder_;
};

TEST_F(HtmlReportTest, ShowsLostFramesAndLoadsNothing) {
  const std::string html = folder_.Read("run/report.html");
  EXPECT_TRUE(Contains(html, "cofusion"));
  EXPECT_TRUE(Contains(html, "a&lt;b&gt;"));
  EXPECT_FALSE(Contains(html, "a<b>"));
  EXPECT_TRUE(Contains(html, "#d00"));
  EXPECT_TRUE(Contains(html, "default-src 'none'"));
  EXPECT_TRUE(
      Contains(html, "alt=\"frame 12\" src=\"data:image/jpeg;base64,/9j/"));
  EXPECT_EQ(Count(html, " src=\""), 1u);
  EXPECT_FALSE(Contains(html, " href=\""));
  EXPECT_TRUE(Contains(html, "</html>"));
}

TEST_F(HtmlReportTest, IsThatOfTheRunReadAgain) {
  const RunPaths paths(folder_ / "run");
  EXPECT_EQ(HtmlReport({ReadReportedRun(paths)}),
            folder_.Read("run/report.html"));
}

TEST_F(HtmlReportTest, CurvesAreThoseOfTheFiles) {
  const RunPaths paths(folder_ / "run");
  const RunCurves curves = ReadReportedRun(paths).curves;
  EXPECT_EQ(curves.frames, (std::vector<int>{10, 11, 12}));
  ASSERT_EQ(curves.surfaces.size(), 2u);
  const SurfaceCurves& surface = curves.surfaces[1];
  EXPECT_EQ(surface.states,
            (std::vector<std::string>{"tracked", "lost", "tracked"}));
  const auto group = [&](const std::string& name) {
    return *std::find_if(
        surface.groups.begin(), surface.groups.end(),
        [&](const CurveGroup& one) { return one.name == name; });
  };
  const CurveGroup cost = group("cost");
  ASSERT_EQ(cost.series.size(), 2u);
  EXPECT_EQ(cost.series[0].name, "point_to_plane");
  EXPECT_EQ(cost.series[0].values[0], 0.1);
  EXPECT_TRUE(std::isnan(cost.series[0].values[2]));
  EXPECT_EQ(cost.series[1].values[2], 0.025);
  EXPECT_EQ(cost.not_finite, std::vector<int>{2}) << "a cost that diverged";
  const CurveGroup points = group("points");
  ASSERT_EQ(points.series.size(), 2u);
  EXPECT_EQ(points.series[0].values[0], 1000);
  EXPECT_EQ(points.series[1].name, "distance");
  EXPECT_EQ(points.series[1].values[0], 200);
  EXPECT_EQ(group("residual").series[0].values[0], 3);
  EXPECT_EQ(group("nodes").series[0].values[1], 120);
}

TEST_F(HtmlReportTest, SeveralRunsAreCompared) {
  ReportedRun run = ReadReportedRun(RunPaths(folder_ / "run"));
  ReportedRun other = run;
  run.name = "one";
  other.name = "two & more";
  other.evaluation = {{"headline", {{"ate_m", 0.00123456}}}};
  const std::string html = HtmlReport({run, other});
  EXPECT_TRUE(Contains(html, "<h2>two &amp; more</h2>"));
  EXPECT_TRUE(Contains(html, "<td class=\"n\">0.001235</td>"));
  EXPECT_TRUE(Contains(html, "<td>-</td>")) << "not evaluated";
}

TEST_F(HtmlReportTest, OfAFolderWithoutARunIsRefused) {
  ExpectInputError([&] { ReadReportedRun(RunPaths(folder_ / "nothing")); },
                   "nothing/summary.json: expected the summary of a run");
  folder_.Write("run/frames.jsonl", "{\"frame\": 1}\n");
  ExpectInputError([&] { ReadReportedRun(RunPaths(folder_ / "run")); },
                   "run/frames.jsonl: not as a run of this version writes it");
  folder_.Write("run/summary.json", "{\"surfaces\": []}");
  ExpectInputError([&] { ReadReportedRun(RunPaths(folder_ / "run")); },
                   "run/summary.json: 'seconds_per_frame' is missing");
}

TEST_F(HtmlReportTest, ASummaryOfAnotherShapeIsRefused) {
  const auto good = nlohmann::json::parse(folder_.Read("run/summary.json"));
  const auto refused = [&](const std::string& key,
                           const nlohmann::json& value) {
    nlohmann::json summary = good;
    summary[key] = value;
    folder_.Write("run/summary.json", summary.dump());
    ExpectInputError([&] { ReadReportedRun(RunPaths(folder_ / "run")); },
                     "summary.json: '" + key + "'");
  };
  refused("seconds_per_frame", 5);
  refused("seconds_per_frame", nlohmann::json::object());
  refused("peak_memory_bytes", "big");
  refused("surfaces", 5);
  refused("surfaces", {{{"id", 0}, {"label", nullptr}, {"nodes", 1}}});
}

TEST_F(HtmlReportTest, RowsHaveAColumnForEveryKey) {
  EXPECT_TRUE(Contains(RowTable({{{"a", 1}}, {{"a", 2}, {"b", 3}}}),
                       "<tr><th>a</th><th>b</th></tr>\n"
                       "<tr><td class=\"n\">1</td><td>-</td></tr>\n"));
}

TEST(Base64, IsThatOfTheStandard) {
  const auto text = [](const std::string& bytes) {
    return Base64(bytes.data(), bytes.size());
  };
  // RFC 4648, 10.
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(text("f"), "Zg==");
  EXPECT_EQ(text("fo"), "Zm8=");
  EXPECT_EQ(text("foo"), "Zm9v");
  EXPECT_EQ(text("foobar"), "Zm9vYmFy");
  EXPECT_EQ(text("\xff\xfe\xfd"), "//79");
}

TEST_F(HtmlReportTest, LetsOnlyItsOwnProgramsAndStyleThrough) {
  const std::string html = folder_.Read("run/report.html");
  EXPECT_TRUE(Contains(html, "style-src 'sha256-"));
  EXPECT_FALSE(Contains(html, "unsafe-inline"));
  EXPECT_FALSE(Contains(html, " style=\""));
  if (!ChartProgram().text.empty()) {
    EXPECT_TRUE(Contains(html, "script-src 'sha256-"));
  }
}

TEST_F(HtmlReportTest, OptionsThatDifferFromTheDefaultsComeFirst) {
  ReportedRun run = ReadReportedRun(RunPaths(folder_ / "run"));
  run.options = {{"a", "1"}, {"b", "2"}, {"c", "3"}};
  run.defaults = {{"b", "20"}, {"c", ""}};
  const std::string html = HtmlReport({run});
  EXPECT_TRUE(Contains(html,
                       "<tr><td>b</td><td>2</td><td>20</td></tr>\n"
                       "<tr><td>c</td><td>3</td><td>-</td></tr>"));
  EXPECT_TRUE(Contains(html, "<th>a</th><td>1</td>"));
}

TEST_F(HtmlReportTest, SaysWhyThereIsNoViewer) {
  // The run of this test has no surfaces/ of its own.
  EXPECT_TRUE(Contains(folder_.Read("run/report.html"), "No viewer: "));
  const ReportedRun run = ReadReportedRun(RunPaths(folder_ / "run"));
  std::vector<std::string> left_out;
  EXPECT_FALSE(Contains(HtmlReport({run}, {false, false}, {}, &left_out),
                        "No viewer: "));
  EXPECT_TRUE(left_out.empty());
  HtmlReport({run}, {}, {}, &left_out);
  ASSERT_EQ(left_out.size(), 1u);
  EXPECT_TRUE(Contains(left_out[0], folder_ / "run"));
}

TEST_F(HtmlReportTest, ManyRunsAreDrawnOverOneAnotherAlone) {
  ReportedRun run = ReadReportedRun(RunPaths(folder_ / "run"));
  std::vector<ReportedRun> runs;
  for (int k = 0; k < 5; ++k) {
    run.name = "run " + std::to_string(k);
    runs.push_back(run);
  }
  const std::string html = HtmlReport(runs, {false, false});
  // Seconds, and seven quantities of two surfaces.
  EXPECT_EQ(Count(html, "<figure class=\"chart\""), 15u);
  EXPECT_TRUE(Contains(html, "{\"name\":\"run 4\",\"values\":[0.125,0.125,"));
  const std::string few = HtmlReport({runs[0], runs[1]}, {false, false});
  EXPECT_EQ(Count(few, "<figure class=\"chart\""), 45u);
}

}  // namespace
}  // namespace splitfusion
