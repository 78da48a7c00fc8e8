#include "splitfusion/lib/page/svg_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "splitfusion/lib/page/html_page.h"

namespace splitfusion {
namespace {

constexpr double kLeft = 56, kTop = 24, kWidth = 572, kHeight = 136;
constexpr double kLine = 16;  // Height of a line of the legend.
constexpr std::array<const char*, 12> kColors = {
    "#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377",
    "#999999", "#dd8833", "#882255", "#44aa99", "#332288", "#ddcc77"};

std::string Number(double value) { return cv::format("%.4g", value); }

/// A round number of which a few make up `range`.
double TickStep(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 3)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (range / (step * power) <= 5) return step * power;
  }
  return 10 * power;
}

/// Axes of a chart: position and value to picture units.
struct Axes {
  std::vector<int> frames;  ///< By position.
  double top = 0;           ///< Value at the upper end; 0 = nothing to draw.
  double margin = 0;        ///< Beside the first and the last position.

  double XOfFrame(double frame) const {
    const double range = frames.back() - frames.front() + 2 * margin;
    const double from = frames.front() - margin;
    return kLeft + kWidth * (range > 0 ? (frame - from) / range : 0.5);
  }
  double X(std::size_t i) const { return XOfFrame(frames[i]); }
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

double SpreadOf(const ChartSeries& series, std::size_t i) {
  const double spread = i < series.spread.size() ? series.spread[i] : 0;
  return std::isfinite(spread) ? spread : 0;
}

/// `series`: as they are drawn.
Axes MakeAxes(const std::vector<ChartSeries>& series, const Chart& chart) {
  Axes axes;
  axes.frames = chart.frames;
  std::size_t count = chart.names.size();
  for (const ChartSeries& item : series) {
    count = std::max(count, item.values.size());
    for (std::size_t i = 0; i < item.values.size(); ++i) {
      const double end = item.values[i] + SpreadOf(item, i);
      if (std::isfinite(end)) axes.top = std::max(axes.top, end);
    }
  }
  if (!chart.names.empty()) axes.margin = 0.5;
  if (chart.frames.empty()) {
    axes.frames.resize(count);
    std::iota(axes.frames.begin(), axes.frames.end(), 0);
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

/// Frame indices below an axis at height `y`.
std::string FrameTicks(const Axes& axes, double y) {
  std::string svg;
  const double first = axes.frames.front(), last = axes.frames.back();
  const double step = std::max(1.0, TickStep(std::max(1.0, last - first)));
  for (double tick = std::ceil(first / step) * step; tick <= last;
       tick += step) {
    svg +=
        TextAt(axes.XOfFrame(tick), y + 14, cv::format("%.0f", tick), "middle");
  }
  return svg;
}

/// Names below an axis, as much of each as there is room for.
std::string NameTicks(const Axes& axes, const std::vector<std::string>& names,
                      double y) {
  std::string svg;
  const double room = kWidth / static_cast<double>(names.size()) / 6.2;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto characters = static_cast<std::size_t>(std::max(2.0, room));
    svg += TextAt(axes.X(i), y + 14, names[i].substr(0, characters), "middle");
  }
  return svg;
}

/// A dot at every value, with its error bar.
std::string Spreads(const ChartSeries& series, const Axes& axes,
                    const std::string& color) {
  std::string svg;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const double spread = SpreadOf(series, i), value = series.values[i];
    if (!std::isfinite(value)) continue;
    svg += "<circle r=\"2.5\" fill=\"" + color + "\" cx=\"" +
           Number(axes.X(i)) + "\" cy=\"" + Number(axes.Y(value)) + "\"/>\n";
    if (spread == 0) continue;
    svg += "<path stroke=\"" + color + "\" d=\"M" + Number(axes.X(i)) + " " +
           Number(axes.Y(value - spread)) + "V" +
           Number(axes.Y(value + spread)) + "\"/>\n";
  }
  return svg;
}

std::string AxesFrame(const Axes& axes, const Chart& chart) {
  std::string svg = "<path fill=\"none\" stroke=\"#888\" d=\"M" +
                    Number(kLeft) + " " + Number(kTop) + "v" + Number(kHeight) +
                    "h" + Number(kWidth) + "\"/>\n";
  const double step = TickStep(axes.top);
  for (int k = 0; k * step <= axes.top; ++k) {
    svg += TextAt(kLeft - 4, axes.Y(k * step) + 4, cv::format("%.6g", k * step),
                  "end");
  }
  return svg + (chart.names.empty()
                    ? TextAt(2, kTop + kHeight + 14, chart.axis) +
                          FrameTicks(axes, kTop + kHeight)
                    : NameTicks(axes, chart.names, kTop + kHeight));
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

/// Names and colours in lines from `y` on; `end`: where the last one ends.
std::string Legend(const std::vector<std::string>& names, double y,
                   double* end) {
  std::string svg;
  double x = kLeft;
  for (std::size_t s = 0; s < names.size(); ++s) {
    const double width = 26 + 6.2 * static_cast<double>(names[s].size());
    if (x > kLeft && x + width > kLeft + kWidth) {
      x = kLeft;
      y += kLine;
    }
    svg += "<rect x=\"" + Number(x) + "\" y=\"" + Number(y - 9) +
           "\" width=\"10\" height=\"10\" fill=\"" +
           kColors[s % kColors.size()] + "\"/>\n";
    svg += TextAt(x + 14, y, names[s]);
    x += width;
  }
  *end = y + kLine;
  return svg;
}

std::string SvgElement(double height, const std::string& label,
                       const std::string& content) {
  return "<svg role=\"img\" aria-label=\"" + HtmlEscaped(label) +
         "\" fill=\"currentColor\" viewBox=\"0 0 640 " + Number(height) +
         "\">\n" + content + "</svg>\n";
}

/// Equal values on end as one bar.
std::string Bars(const Strip& strip, const std::vector<std::string>& values,
                 const Axes& axes, double y) {
  std::string svg;
  const std::size_t count = strip.values.size();
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && strip.values[end] == strip.values[begin]) ++end;
    const auto found =
        std::find(values.begin(), values.end(), strip.values[begin]);
    if (found == values.end()) continue;
    const double left = axes.X(begin);
    const double right = end < count ? axes.X(end) : axes.X(count - 1);
    svg += "<rect x=\"" + Number(left) + "\" y=\"" + Number(y) + "\" width=\"" +
           Number(std::max(1.0, right - left)) + "\" height=\"12\" fill=\"" +
           kColors[(found - values.begin()) % kColors.size()] + "\"/>\n";
  }
  return svg;
}

/// Small triangles over a strip.
std::string StripMarks(const Strip& strip, const Axes& axes, double y) {
  std::string svg;
  for (const StripMark& mark : strip.marks) {
    svg += "<path stroke=\"#888\" d=\"M" + Number(axes.X(mark.position)) + " " +
           Number(y + 8) + "l-4 -8h8z\"><title>" + HtmlEscaped(mark.text) +
           "</title></path>\n";
  }
  return svg;
}

}  // namespace

std::string SvgChart(const Chart& chart) {
  const auto series = chart.stacked ? Stacked(chart.series) : chart.series;
  const Axes axes = MakeAxes(series, chart);
  std::string svg = TextAt(kLeft, 14, chart.title);
  if (axes.top <= 0) {
    return SvgElement(
        100, chart.title,
        svg + TextAt(kLeft, 80, "no values") + Marks(chart.marks, axes));
  }
  std::vector<std::string> names;
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string color = kColors[s % kColors.size()];
    svg += chart.stacked
               ? Area(series[s], s > 0 ? &series[s - 1] : nullptr, axes, color)
               : Line(series[s], axes, color);
    if (!chart.names.empty()) svg += Spreads(series[s], axes, color);
    names.push_back(series[s].name);
  }
  double end = 0;
  svg += Marks(chart.marks, axes) + AxesFrame(axes, chart) +
         Legend(names, kTop + kHeight + 32, &end);
  return SvgElement(end, chart.title, svg);
}

std::string SvgStrips(const std::vector<Strip>& strips,
                      const std::vector<std::string>& values,
                      const std::vector<int>& frames) {
  if (frames.empty()) return "";
  Axes axes;
  axes.frames = frames;
  std::string svg, names;
  double y = 4;
  for (const Strip& strip : strips) {
    svg += TextAt(kLeft - 4, y + 10, strip.name, "end") +
           Bars(strip, values, axes, y) + StripMarks(strip, axes, y);
    names += strip.name + " ";
    y += kLine;
  }
  svg += FrameTicks(axes, y);
  double end = 0;
  svg += Legend(values, y + 32, &end);
  return SvgElement(end, "over the frames: " + names, svg);
}

std::vector<std::string> ChartColors() {
  return {kColors.begin(), kColors.end()};
}

std::string SvgFile(const std::string& element) {
  const std::string begin = "<svg ";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" color=\"black\" "
         "font-family=\"sans-serif\" font-size=\"11\" " +
         element.substr(begin.size());
}

}  // namespace splitfusion
