#include "splitfusion/lib/report/html_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/report/svg_chart.h"
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
      SvgChart({"cost", {{"a", {1, NAN, 4, 2}}}, {}, false});
  EXPECT_EQ(Count(svg, "<polyline"), 2u);
  EXPECT_TRUE(Contains(svg, ">4</text>"));
  EXPECT_FALSE(Contains(svg, "nan"));
  // From the upper end (4) to its half (2) at the right end; no way back.
  EXPECT_TRUE(Contains(svg, "points=\"437.3,24 628,92 628,92 \""));
}

TEST(SvgChart, StacksAreas) {
  const std::string svg =
      SvgChart({"time", {{"a", {1, 1}}, {"b", {2, NAN}}}, {}, true});
  EXPECT_EQ(Count(svg, "<polygon"), 2u);
  EXPECT_TRUE(Contains(svg, ">3</text>"));  // 1 + 2.
}

TEST(SvgChart, SaysWhenThereIsNothing) {
  EXPECT_TRUE(Contains(SvgChart({"cost", {}, {}, false}), "no values"));
  EXPECT_TRUE(
      Contains(SvgChart({"cost", {{"a", {NAN}}}, {}, false}), "no values"));
}

TEST(HtmlReport, ShowsLostFramesAndLoadsNothing) {
  const TemporaryFolder folder;
  RunDirectory run(folder / "run", {"cofusion", "", {}});
  for (int frame = 0; frame < 3; ++frame) {
    FrameReport report = SampleReport(frame);
    report.surfaces[1].label = "a<b>";
    if (frame == 1) report.surfaces[1].state = TrackState::kLost;
    run.AddFrame(report, {});
  }
  folder.Write("run/pictures/000002_montage.png", "");
  run.Finish();
  const std::string html = folder.Read("run/report.html");
  EXPECT_TRUE(Contains(html, "cofusion"));
  EXPECT_TRUE(Contains(html, "a&lt;b&gt;"));
  EXPECT_TRUE(Contains(html, "#d00"));
  EXPECT_TRUE(Contains(html, "href=\"pictures/000002_montage.png\""));
  EXPECT_FALSE(Contains(html, "src="));
  EXPECT_FALSE(Contains(html, "http"));
  EXPECT_TRUE(Contains(html, "</html>"));
}

}  // namespace
}  // namespace splitfusion
