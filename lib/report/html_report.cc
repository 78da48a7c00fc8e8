#include "splitfusion/lib/report/html_report.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/report/frame_parts.h"
#include "splitfusion/lib/report/json_lines.h"
#include "splitfusion/lib/report/svg_chart.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>SplitFusion run</title>
<style>
body{font:14px sans-serif;max-width:1340px;margin:1em auto;color:#222}
table{border-collapse:collapse}td,th{padding:2px 12px 2px 0;text-align:left}
svg{width:640px;max-width:100%;font:11px sans-serif}h1,h2{font-weight:normal}
</style></head><body>
<h1>SplitFusion run</h1>
)";

std::string Cell(const Json& value) {
  const std::string text =
      value.is_string() ? value.get<std::string>() : value.dump();
  return "<td>" + HtmlEscaped(text) + "</td>";
}

/// Two columns, key and value, of an object without nested tables.
std::string KeyTable(const Json& object) {
  std::string html = "<table>\n";
  for (const auto& [key, value] : object.items()) {
    html += "<tr><th>" + HtmlEscaped(key) + "</th>" + Cell(value) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string SurfaceTable(const Json& surfaces) {
  if (surfaces.empty()) return "<p>none</p>\n";
  std::string html = "<table>\n<tr>";
  for (const auto& [key, value] : surfaces.front().items()) {
    html += "<th>" + HtmlEscaped(key) + "</th>";
  }
  for (const Json& surface : surfaces) {
    html += "</tr>\n<tr>";
    for (const auto& [key, value] : surface.items()) html += Cell(value);
  }
  return html + "</tr>\n</table>\n";
}

/// The facts of the whole run, nested values flattened or left to other tables.
std::string SummaryTable(const Json& summary) {
  Json flat;
  for (const auto& [key, value] : summary.items()) {
    if (!value.is_structured()) flat[key] = value;
  }
  const Json& seconds = summary.at("seconds_per_frame");
  flat["seconds per frame, median"] = seconds.at("median");
  flat["seconds per frame, mean"] = seconds.at("mean");
  for (const auto& [part, value] : seconds.at("parts").items()) {
    flat["seconds per frame, " + part] = value;
  }
  return KeyTable(flat);
}

const Json* FindSurface(const Json& frame, int id) {
  for (const Json& surface : frame.at("surfaces")) {
    if (surface.at("id") == id) return &surface;
  }
  return nullptr;
}

double NumberOrGap(const Json& value) {
  return value.is_number() ? value.get<double>() : kNoValue;
}

/// A number of a surface in a frame; kNoValue where there is none.
using SurfaceValue = std::function<double(const Json& surface)>;

double FinalCost(const Json& surface) {
  const Json& rounds = surface.at("rounds");
  if (rounds.empty()) return kNoValue;
  return NumberOrGap(rounds.back().at("solver").at("final_cost"));
}

double ResidualMillimetres(const Json& surface) {
  if (surface.at("rounds").empty()) return kNoValue;
  return 1000 * NumberOrGap(surface.at("residual_rms"));
}

double AcceptedPoints(const Json& surface) {
  const Json& rounds = surface.at("rounds");
  if (rounds.empty()) return kNoValue;
  return NumberOrGap(rounds.back().at("association").at("accepted"));
}

double Nodes(const Json& surface) { return NumberOrGap(surface.at("nodes")); }

std::vector<int> LostPositions(const std::vector<Json>& frames) {
  std::vector<int> positions;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Json& surfaces = frames[i].at("surfaces");
    if (std::any_of(surfaces.begin(), surfaces.end(),
                    [](const Json& s) { return s.at("state") == "lost"; })) {
      positions.push_back(static_cast<int>(i));
    }
  }
  return positions;
}

/// One line per surface of the summary.
std::string SurfaceChart(const std::string& title, const Json& surfaces,
                         const std::vector<Json>& frames,
                         const SurfaceValue& value) {
  Chart chart{title, {}, LostPositions(frames), false};
  for (const Json& item : surfaces) {
    const int id = item.at("id");
    ChartSeries series{
        RunPaths::SurfaceName(id, item.at("label").get<std::string>()), {}};
    for (const Json& frame : frames) {
      const Json* surface = FindSurface(frame, id);
      series.values.push_back(surface ? value(*surface) : kNoValue);
    }
    chart.series.push_back(series);
  }
  return SvgChart(chart);
}

std::string TimeChart(const std::vector<Json>& frames) {
  Chart chart{"seconds by part", {}, {}, true};
  for (const FramePart& part : kFrameParts) {
    ChartSeries series{part.name, {}};
    for (const Json& frame : frames) {
      series.values.push_back(NumberOrGap(frame.at("seconds").at(part.name)));
    }
    chart.series.push_back(series);
  }
  return SvgChart(chart);
}

std::string PictureLinks(const std::string& folder) {
  std::error_code missing;
  std::set<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename().string();
    if (name.find("_montage.png") != std::string::npos) names.insert(name);
  }
  if (names.empty()) return "";
  std::string html = "<h2>Pictures</h2>\n<p>";
  for (const std::string& name : names) {
    html += "<a href=\"pictures/" + name + "\">" +
            name.substr(0, name.find('_')) + "</a> ";
  }
  return html + "</p>\n";
}

}  // namespace

void WriteHtmlReport(const RunPaths& paths, const Json& summary) {
  const std::vector<Json> frames = ReadJsonLines(paths.Frames());
  const Json& surfaces = summary.at("surfaces");
  const auto chart = [&](const std::string& title, const SurfaceValue& value) {
    return SurfaceChart(title, surfaces, frames, value);
  };
  WriteFileAtomically(paths.HtmlReport(), [&](std::ostream& out) {
    out << kHead << SummaryTable(summary) << "<h2>Surfaces</h2>\n"
        << SurfaceTable(surfaces) << "<h2>Over the frames</h2>\n"
        << TimeChart(frames) << chart("final cost", FinalCost)
        << chart("point-to-plane residual, RMS, mm", ResidualMillimetres)
        << chart("accepted points of the last round", AcceptedPoints)
        << chart("nodes", Nodes) << PictureLinks(paths.Pictures())
        << "<h2>Versions</h2>\n"
        << KeyTable(summary.at("versions")) << "</body></html>\n";
  });
}

}  // namespace splitfusion
