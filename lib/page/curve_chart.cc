#include "splitfusion/lib/page/curve_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "splitfusion/lib/page/html_page.h"
#include "splitfusion/lib/page/svg_chart.h"

namespace splitfusion {
namespace {

constexpr double kLeft = 72, kTop = 32, kWidth = 440, kHeight = 300;
constexpr double kBelow = 48, kLetter = 7, kLine = 17;  // Of text.
/// Colours that also the colour-blind tell apart (Tol), dashed from the eighth
/// on.
constexpr std::array<const char*, 7> kColors = {"#4477aa", "#ee6677", "#228833",
                                                "#ccbb44", "#66ccee", "#aa3377",
                                                "#777777"};
constexpr std::array<const char*, 3> kDashes = {"none", "6 3", "2 3"};

std::string Number(double value) { return cv::format("%.4g", value); }

std::string Text(double x, double y, const std::string& attributes,
                 const std::string& text) {
  return "<text x=\"" + Number(x) + "\" y=\"" + Number(y) + "\" " + attributes +
         ">" + HtmlEscaped(text) + "</text>\n";
}

std::string Line(double x0, double y0, double x1, double y1,
                 const std::string& color) {
  return "<line x1=\"" + Number(x0) + "\" y1=\"" + Number(y0) + "\" x2=\"" +
         Number(x1) + "\" y2=\"" + Number(y1) + "\" stroke=\"" + color +
         "\"/>\n";
}

/// Values of one axis, and where they are from 0 to 1.
class Scale {
 public:
  explicit Scale(bool logarithmic) : logarithmic_(logarithmic) {}

  bool CanShow(double value) const {
    return std::isfinite(value) && (!logarithmic_ || value > 0);
  }

  void Include(double value) {
    low_ = std::min(low_, Inner(value));
    high_ = std::max(high_, Inner(value));
  }

  bool empty() const { return low_ > high_; }

  /// Ends at whole powers, or at whole steps of the ticks.
  void Finish() {
    if (logarithmic_) {
      low_ = std::floor(low_);
      high_ = std::max(std::ceil(high_), low_ + 1);
      step_ = std::max(1.0, std::ceil((high_ - low_) / 8));
      return;
    }
    low_ = std::min(low_, 0.0);
    const double span = std::max(high_ - low_, 1e-12);
    const double power = std::pow(10.0, std::floor(std::log10(span / 4)));
    const double rest = span / 4 / power;
    step_ = power * (rest < 1.5 ? 1 : rest < 3.5 ? 2 : rest < 7.5 ? 5 : 10);
    high_ = low_ + step_ * std::ceil(span / step_ - 1e-9);
  }

  double At(double value) const {
    return (Inner(value) - low_) / (high_ - low_);
  }

  std::vector<double> Ticks() const {
    std::vector<double> ticks;
    for (double inner = low_; inner < high_ + 0.5 * step_; inner += step_) {
      ticks.push_back(logarithmic_ ? std::pow(10.0, inner) : inner);
    }
    return ticks;
  }

 private:
  double Inner(double value) const {
    return logarithmic_ ? std::log10(value) : value;
  }

  bool logarithmic_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double step_ = 1;
};

/// Both axes of a chart.
struct Scales {
  Scale x, y;

  double X(double value) const { return kLeft + kWidth * x.At(value); }
  double Y(double value) const { return kTop + kHeight * (1 - y.At(value)); }
};

Scales MakeScales(const CurveChart& chart) {
  Scales scales{Scale(chart.x.logarithmic), Scale(chart.y.logarithmic)};
  for (const Curve& curve : chart.curves) {
    for (const auto& [x, y] : curve.points) {
      if (!scales.x.CanShow(x) || !scales.y.CanShow(y)) continue;
      scales.x.Include(x);
      scales.y.Include(y);
    }
  }
  if (scales.x.empty()) return scales;
  scales.x.Finish();
  scales.y.Finish();
  return scales;
}

std::string Grid(const Scales& scales) {
  const std::string middle = "text-anchor=\"middle\"";
  const std::string end = "text-anchor=\"end\"";
  const double bottom = kTop + kHeight;
  std::string svg;
  for (const double tick : scales.x.Ticks()) {
    const double x = scales.X(tick);
    svg += Line(x, kTop, x, bottom, "#dddddd");
    svg += Text(x, bottom + kLine, middle, Number(tick));
  }
  for (const double tick : scales.y.Ticks()) {
    const double y = scales.Y(tick);
    svg += Line(kLeft, y, kLeft + kWidth, y, "#dddddd");
    svg += Text(kLeft - 6, y + 4, end, Number(tick));
  }
  return svg;
}

std::string Labels(const CurveChart& chart) {
  const std::string middle = "text-anchor=\"middle\"";
  const double height = kTop + kHeight / 2;
  return Text(kLeft, kTop - 12, "font-weight=\"bold\"", chart.title) +
         Text(kLeft + kWidth / 2, kTop + kHeight + kBelow - 10, middle,
              chart.x.label) +
         Text(14, height,
              middle + " transform=\"rotate(-90 14 " + Number(height) + ")\"",
              chart.y.label);
}

std::string Style(std::size_t index) {
  return std::string("fill=\"none\" stroke-width=\"1.5\" stroke=\"") +
         kColors[index % kColors.size()] + "\" stroke-dasharray=\"" +
         kDashes[index / kColors.size() % kDashes.size()] + "\"";
}

std::string Path(const Curve& curve, std::size_t index, bool steps,
                 const Scales& scales) {
  std::string points;
  double last = 0;
  for (const auto& [x, y] : curve.points) {
    if (!scales.x.CanShow(x) || !scales.y.CanShow(y)) continue;
    const std::string at = Number(scales.X(x)) + ",";
    if (steps && !points.empty()) points += at + Number(last) + " ";
    last = scales.Y(y);
    points += at + Number(last) + " ";
  }
  if (points.empty()) return "";
  return "<polyline " + Style(index) + " points=\"" + points + "\"/>\n";
}

std::string Legend(const CurveChart& chart) {
  std::string svg;
  const double x = kLeft + kWidth + 16;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const double y = kTop + kLine * (static_cast<double>(i) + 0.5);
    svg += "<polyline " + Style(i) + " points=\"" + Number(x) + "," +
           Number(y) + " " + Number(x + 24) + "," + Number(y) + "\"/>\n";
    svg += Text(x + 30, y + 4, "", chart.curves[i].name);
  }
  return svg;
}

}  // namespace

std::string CurveChartSvg(const CurveChart& chart) {
  const double rows = static_cast<double>(chart.curves.size());
  std::size_t letters = 0;
  for (const Curve& curve : chart.curves) {
    letters = std::max(letters, curve.name.size());
  }
  const double width =
      kLeft + kWidth + 56 + kLetter * static_cast<double>(letters);
  const double height = kTop + std::max(kHeight, kLine * rows) + kBelow;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    Number(width) + "\" height=\"" + Number(height) +
                    "\" viewBox=\"0 0 " + Number(width) + " " + Number(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  const Scales scales = MakeScales(chart);
  svg += Labels(chart) + Legend(chart);
  if (scales.x.empty()) {
    return svg + Text(kLeft, kTop + kHeight / 2, "", "no values") + "</svg>\n";
  }
  svg += Grid(scales);
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    svg += Path(chart.curves[i], i, chart.steps, scales);
  }
  return svg + "</svg>\n";
}

}  // namespace splitfusion
