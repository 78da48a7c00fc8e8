#include "splitfusion/lib/page/html_page.h"

#include <cmath>

#include "splitfusion/lib/base/base64.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/page/html_tables.h"
#include "splitfusion/lib/page/page_bundle.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// A source of a Content-Security-Policy: 'sha256-...'.
std::string HashSource(const PagePart& part) {
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i + 1 < part.sha256.size(); i += 2) {
    bytes.push_back(static_cast<unsigned char>(
        std::stoi(std::string(part.sha256.substr(i, 2)), nullptr, 16)));
  }
  return "'sha256-" + Base64(bytes.data(), bytes.size()) + "'";
}

/// JSON within a script element, which "</script" would end.
std::string DataOf(const Json& value) {
  std::string text = JsonText(value);
  for (auto at = text.find('<'); at != std::string::npos;
       at = text.find('<', at)) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

/// What is no finite number becomes null.
Json NumbersOf(const std::vector<double>& values) {
  Json numbers = Json::array();
  for (const double value : values) {
    numbers.push_back(std::isfinite(value) ? Json(value) : Json());
  }
  return numbers;
}

Json SeriesOf(const std::vector<ChartSeries>& all) {
  Json result = Json::array();
  for (const ChartSeries& series : all) {
    Json one = {{"name", series.name}, {"values", NumbersOf(series.values)}};
    if (!series.spread.empty()) one["spread"] = NumbersOf(series.spread);
    result.push_back(one);
  }
  return result;
}

/// Frames, or positions among names.
std::vector<int> PlacesOf(const Chart& chart) {
  if (!chart.frames.empty()) return chart.frames;
  std::vector<int> places;
  const std::size_t count = chart.names.empty() && !chart.series.empty()
                                ? chart.series[0].values.size()
                                : chart.names.size();
  for (std::size_t i = 0; i < count; ++i) {
    places.push_back(static_cast<int>(i));
  }
  return places;
}

std::string Head(const std::vector<PagePart>& programs) {
  std::string policy =
      "default-src 'none'; base-uri 'none'; form-action 'none'; "
      "img-src data:; style-src " +
      HashSource(PageStyle());
  if (!programs.empty()) policy += "; script-src";
  for (const PagePart& program : programs) policy += " " + HashSource(program);
  return R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content=")" +
         policy + "\">\n<title>SplitFusion report</title>\n<style>" +
         std::string(PageStyle().text) + "</style></head><body>\n";
}

}  // namespace

void HtmlPage::AddChart(const Chart& chart, const std::string& group) {
  const int index =
      places_.try_emplace(PlacesOf(chart), static_cast<int>(places_.size()))
          .first->second;
  body_ +=
      "<figure class=\"chart\" role=\"group\" tabindex=\"0\" aria-label=\"" +
      HtmlEscaped(chart.title) + "\" data-chart=\"" +
      std::to_string(charts_.size()) + "\">" + SvgChart(chart) +
      "<div class=\"plot\"></div></figure>\n";
  Json data = {{"title", chart.title}, {"stacked", chart.stacked},
               {"group", group},       {"frames", chart.names.empty()},
               {"x", index},           {"x_title", chart.axis},
               {"marks", chart.marks}, {"series", SeriesOf(chart.series)}};
  if (!chart.names.empty()) data["x_names"] = chart.names;
  charts_.push_back(data);
}

void HtmlPage::AddViewer(const RunScene& scene, const std::string& group) {
  if (ViewerProgram().text.empty()) {
    body_ +=
        "<p>No viewer: this program was built without node, or without the "
        "packages of its page.</p>\n";
    return;
  }
  has_viewer_ = true;
  Json header = scene.header;
  header["run"] = group;
  body_ += "<div class=\"viewer\">" + Heading("Surfaces in 3D") +
           "<script type=\"application/json\" class=\"scene\">" +
           DataOf(header) +
           "</script><script type=\"text/plain\" class=\"arrays\">" +
           scene.arrays + "</script></div>\n";
}

std::string HtmlPage::Text() const {
  std::vector<PagePart> programs;
  if (!ChartProgram().text.empty()) programs.push_back(ChartProgram());
  if (has_viewer_) programs.push_back(ViewerProgram());
  std::vector<std::vector<int>> places(places_.size());
  for (const auto& [values, index] : places_) places[index] = values;
  const Json data = {
      {"colors", ChartColors()}, {"places", places}, {"charts", charts_}};
  std::string html = Head(programs) + body_ +
                     "<script type=\"application/json\" id=\"charts\">" +
                     DataOf(data) + "</script>\n";
  for (const PagePart& program : programs) {
    html += "<script>" + std::string(program.text) + "</script>\n";
  }
  return html + "</body></html>\n";
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
