#include "splitfusion/lib/report/svg_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>

namespace splitfusion {
namespace {

constexpr double kLeft = 56, kTop = 24, kWidth = 572, kHeight = 136;
constexpr std::array<const char*, 8> kColors = {"#4477aa", "#ee6677", "#228833",
                                                "#ccbb44", "#66ccee", "#aa3377",
                                                "#999999", "#dd8833"};

std::string Number(double value) { return cv::format("%.4g", value); }

/// Axes of a chart: position and value to picture units.
struct Axes {
  std::size_t count = 0;  ///< Positions.
  double top = 0;         ///< Value at the upper end; 0 = nothing to draw.

  double X(std::size_t i) const {
    return kLeft + kWidth * (count < 2 ? 0.5 : double(i) / double(count - 1));
  }
  double Y(double value) const { return kTop + kHeight * (1 - value / top); }
  std::string Point(std::size_t i, double value) const {
    return Number(X(i)) + "," + Number(Y(value)) + " ";
  }
};

/// Running sums over the series, for areas on top of each other; NaN adds 0.
std::vector<ChartSeries> Stacked(std::vector<ChartSeries> series) {
  for (std::size_t s = 0; s < series.size(); ++s) {
    for (std::size_t i = 0; i < series[s].values.size(); ++i) {
      double& value = series[s].values[i];
      if (!std::isfinite(value)) value = 0;
      if (s > 0) value += series[s - 1].values[i];
    }
  }
  return series;
}

Axes MakeAxes(const std::vector<ChartSeries>& series) {
  Axes axes;
  for (const ChartSeries& item : series) {
    axes.count = std::max(axes.count, item.values.size());
    for (const double value : item.values) {
      if (std::isfinite(value)) axes.top = std::max(axes.top, value);
    }
  }
  return axes;
}

/// Line pieces between gaps. The last point stands twice, so that a single
/// value becomes a dot.
std::string Line(const ChartSeries& series, const Axes& axes,
                 const std::string& color) {
  std::string svg, points, last;
  for (std::size_t i = 0; i <= series.values.size(); ++i) {
    if (i < series.values.size() && std::isfinite(series.values[i])) {
      last = axes.Point(i, series.values[i]);
      points += last;
    } else if (!points.empty()) {
      svg += "<polyline fill=\"none\" stroke=\"" + color +
             "\" stroke-linecap=\"round\" points=\"" + points + last + "\"/>\n";
      points.clear();
    }
  }
  return svg;
}

/// Area between a stacked series and the one below it (null: the axis).
std::string Area(const ChartSeries& series, const ChartSeries* below,
                 const Axes& axes, const std::string& color) {
  std::string points;
  const std::size_t count = series.values.size();
  for (std::size_t i = 0; i < count; ++i) {
    points += axes.Point(i, series.values[i]);
  }
  for (std::size_t i = count; i-- > 0;) {
    points += axes.Point(i, below ? below->values[i] : 0);
  }
  return "<polygon fill=\"" + color + "\" points=\"" + points + "\"/>\n";
}

std::string TextAt(double x, double y, const std::string& text,
                   const std::string& anchor = "start") {
  return "<text x=\"" + Number(x) + "\" y=\"" + Number(y) +
         "\" text-anchor=\"" + anchor + "\">" + HtmlEscaped(text) + "</text>\n";
}

std::string AxesFrame(const Axes& axes) {
  std::string svg = "<path fill=\"none\" stroke=\"#888\" d=\"M" +
                    Number(kLeft) + " " + Number(kTop) + "v" + Number(kHeight) +
                    "h" + Number(kWidth) + "\"/>\n";
  svg += TextAt(kLeft - 4, kTop + 8, Number(axes.top), "end");
  svg += TextAt(kLeft - 4, kTop + kHeight, "0", "end");
  svg += TextAt(kLeft, kTop + kHeight + 14, "0");
  svg += TextAt(kLeft + kWidth, kTop + kHeight + 14,
                std::to_string(axes.count - 1), "end");
  return svg;
}

std::string Marks(const std::vector<int>& marks, const Axes& axes) {
  std::string svg;
  for (const int mark : marks) {
    svg += "<path stroke=\"#d00\" stroke-opacity=\"0.5\" d=\"M" +
           Number(axes.X(mark)) + " " + Number(kTop) + "v" + Number(kHeight) +
           "\"/>\n";
  }
  return svg;
}

std::string Legend(const std::vector<ChartSeries>& series) {
  std::string svg;
  double x = kLeft;
  for (std::size_t s = 0; s < series.size(); ++s) {
    svg += "<rect x=\"" + Number(x) +
           "\" y=\"184\" width=\"10\" height=\"10\" "
           "fill=\"" +
           kColors[s % kColors.size()] + "\"/>\n";
    svg += TextAt(x + 14, 193, series[s].name);
    x += 26 + 6.2 * static_cast<double>(series[s].name.size());
  }
  return svg;
}

}  // namespace

std::string SvgChart(const Chart& chart) {
  const auto series = chart.stacked ? Stacked(chart.series) : chart.series;
  const Axes axes = MakeAxes(series);
  std::string svg = "<svg viewBox=\"0 0 640 200\">\n";
  svg += TextAt(kLeft, 14, chart.title);
  if (axes.top <= 0) {
    return svg + TextAt(kLeft, 80, "no values") + "</svg>\n";
  }
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string color = kColors[s % kColors.size()];
    svg += chart.stacked
               ? Area(series[s], s > 0 ? &series[s - 1] : nullptr, axes, color)
               : Line(series[s], axes, color);
  }
  return svg + Marks(chart.marks, axes) + AxesFrame(axes) + Legend(series) +
         "</svg>\n";
}

std::string HtmlEscaped(const std::string& text) {
  static const std::map<char, std::string> special = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string escaped;
  for (const char c : text) {
    const auto found = special.find(c);
    escaped += found == special.end() ? std::string(1, c) : found->second;
  }
  return escaped;
}

}  // namespace splitfusion
