#ifndef SPLITFUSION_LIB_REPORT_SVG_CHART_H_
#define SPLITFUSION_LIB_REPORT_SVG_CHART_H_

#include <string>
#include <vector>

namespace splitfusion {

/// One named row of values; NaN is a gap.
struct ChartSeries {
  std::string name;            ///< For the legend.
  std::vector<double> values;  ///< One per position on the horizontal axis.
};

/// A small chart over frames.
struct Chart {
  std::string title;                ///< With the unit of the vertical axis.
  std::vector<ChartSeries> series;  ///< Of equal length.
  std::vector<int> marks;           ///< Positions marked red (lost frames).
  bool stacked = false;  ///< Areas on top of each other instead of lines.
};

/// The chart as one inline SVG element, 640x200 units: vertical axis from 0
/// to the largest value, legend below. A chart without values says so.
std::string SvgChart(const Chart& chart);

/// Text with the characters special to HTML replaced.
std::string HtmlEscaped(const std::string& text);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_SVG_CHART_H_
