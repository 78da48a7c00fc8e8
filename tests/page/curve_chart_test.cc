#include "splitfusion/lib/page/curve_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace splitfusion {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CurveChart SampleChart() {
  CurveChart chart;
  chart.title = "Gap & time";
  chart.x = {"seconds", true};
  chart.y = {"share", false};
  chart.curves = {{"a<b", {{0.1, 0}, {1, 0.5}, {10, 1}}}};
  return chart;
}

/// Places of the points of the first curve, as drawn.
std::vector<std::pair<double, double>> Drawn(const std::string& svg) {
  // The legend comes first, the curves last.
  const std::size_t line = svg.rfind("<polyline");
  const std::size_t begin = svg.find("points=\"", line) + 8;
  std::istringstream points(svg.substr(begin, svg.find('"', begin) - begin));
  std::vector<std::pair<double, double>> places;
  double x = 0, y = 0;
  for (char comma = 0; points >> x >> comma >> y;) places.emplace_back(x, y);
  return places;
}

TEST(CurveChart, HasTitleLabelsLegendAndTicks) {
  const std::string svg = CurveChartSvg(SampleChart());
  EXPECT_EQ(svg.find("<svg xmlns="), 0u);
  for (const char* text : {">Gap &amp; time</text>", ">seconds</text>",
                           ">share</text>", ">a&lt;b</text>", ">0.1</text>",
                           ">1</text>", ">10</text>", ">0</text>"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_THAT(svg, HasSubstr("</svg>"));
}

TEST(CurveChart, PowersOfTenAreEquallyFarApart) {
  const auto places = Drawn(CurveChartSvg(SampleChart()));
  ASSERT_EQ(places.size(), 3u);
  EXPECT_NEAR(places[1].first - places[0].first,
              places[2].first - places[1].first, 0.2);
  EXPECT_GT(places[1].first, places[0].first + 10);
  EXPECT_NEAR(places[0].second - places[1].second,
              places[1].second - places[2].second, 0.2);
  EXPECT_LT(places[2].second, places[0].second);  // Up.
}

TEST(CurveChart, StepsHoldAValueUntilTheNext) {
  CurveChart chart = SampleChart();
  chart.steps = true;
  const auto places = Drawn(CurveChartSvg(chart));
  ASSERT_EQ(places.size(), 5u);
  EXPECT_EQ(places[1].first, places[2].first);
  EXPECT_EQ(places[1].second, places[0].second);
}

TEST(CurveChart, LeavesOutWhatCannotBeShown) {
  CurveChart chart = SampleChart();
  auto& points = chart.curves[0].points;
  points.insert(points.begin(), {-1, 0.2});
  points.emplace_back(20, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(Drawn(CurveChartSvg(chart)).size(), 3u);
  points = {{0, 1}};
  const std::string svg = CurveChartSvg(chart);
  EXPECT_THAT(svg, HasSubstr("no values"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace splitfusion
