#ifndef SPLITFUSION_LIB_PAGE_CURVE_CHART_H_
#define SPLITFUSION_LIB_PAGE_CURVE_CHART_H_

#include <string>
#include <utility>
#include <vector>

namespace splitfusion {

/// A named line through points (x, y), in order of x.
struct Curve {
  std::string name;                               ///< For the legend.
  std::vector<std::pair<double, double>> points;  ///< Those not finite, or not
                                                  ///< above 0 on a logarithmic
                                                  ///< axis, are left out.
};

/// An axis of a chart.
struct ChartAxis {
  std::string label;         ///< With its unit.
  bool logarithmic = false;  ///< Powers of ten at equal distances.
};

/// A figure for a paper or a report: both axes with ticks and labels, a legend.
struct CurveChart {
  std::string title;          ///< Above it.
  ChartAxis x;                ///< To the right.
  ChartAxis y;                ///< Upwards.
  std::vector<Curve> curves;  ///< At most a score can be told apart.
  bool steps = false;         ///< A value holds until the next point.
};

/// The chart as a whole SVG file; one without points says so.
std::string CurveChartSvg(const CurveChart& chart);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_CURVE_CHART_H_
