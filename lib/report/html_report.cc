#include "splitfusion/lib/report/html_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/base64.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/report/json_lines.h"
#include "splitfusion/lib/report/svg_chart.h"
#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Pictures of a run that are shown, and their width, pixels.
constexpr std::size_t kPictures = 24;  // Layout.
constexpr int kPictureWidth = 800;     // Layout.

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<title>SplitFusion report</title>
<style>
:root{color-scheme:light dark}
body{font:14px/1.4 sans-serif;max-width:1340px;margin:1em auto;padding:0 1em}
h1,h2,h3{font-weight:normal;margin:1.2em 0 .3em}
.wide{overflow-x:auto}
table{border-collapse:collapse}
td,th{padding:2px 14px 2px 0;text-align:left;vertical-align:top}
.rows td.n{text-align:right;font-variant-numeric:tabular-nums}
.charts{display:grid;gap:8px 20px;
 grid-template-columns:repeat(auto-fill,minmax(min(100%,420px),1fr))}
svg{width:100%;font:11px sans-serif}
figure{display:inline-block;margin:0 8px 8px 0}
figure img{max-width:100%;height:auto}
summary{cursor:pointer;margin:.4em 0}
@media print{svg,figure{break-inside:avoid}}
</style></head><body>
)";

/// A number as people read it: four digits, whole ones as they are.
std::string Rounded(double value) {
  if (std::abs(value) < 1e15 && value == std::floor(value)) {
    return cv::format("%.0f", value);
  }
  return cv::format("%.4g", value);
}

std::string TextOf(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_number()) return Rounded(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return JsonText(value);
  std::string text;
  for (const Json& item : value) {
    text += (text.empty() ? "" : ", ") + TextOf(item);
  }
  return text;
}

std::string Cell(const Json& value) {
  return (value.is_number() ? "<td class=\"n\">" : "<td>") +
         HtmlEscaped(TextOf(value)) + "</td>";
}

std::string Heading(const std::string& text) {
  return "<h3>" + HtmlEscaped(text) + "</h3>\n";
}

/// Rows of key and value.
std::string KeyTable(const Json& object) {
  std::string html = "<div class=\"wide\"><table>\n";
  for (const auto& [key, value] : object.items()) {
    html += "<tr><th>" + HtmlEscaped(key) + "</th>" + Cell(value) + "</tr>\n";
  }
  return html + "</table></div>\n";
}

/// Without lists, such as frames, which the states show.
Json WithoutLists(const Json& rows) {
  Json result = Json::array();
  for (const Json& row : rows) {
    Json kept;
    for (const auto& [key, value] : row.items()) {
      if (!value.is_structured()) kept[key] = value;
    }
    result.push_back(kept);
  }
  return result;
}

/// Objects with the same keys, one a row.
std::string RowTable(const Json& rows) {
  if (rows.empty()) return "<p>none</p>\n";
  std::string html = "<div class=\"wide\"><table class=\"rows\">\n<tr>";
  for (const auto& [key, value] : rows.front().items()) {
    html += "<th>" + HtmlEscaped(key) + "</th>";
  }
  for (const Json& row : rows) {
    html += "</tr>\n<tr>";
    for (const auto& [key, value] : row.items()) html += Cell(value);
  }
  return html + "</tr>\n</table></div>\n";
}

std::string Details(const std::string& title, const std::string& content) {
  return "<details><summary>" + HtmlEscaped(title) + "</summary>\n" + content +
         "</details>\n";
}

/// The facts of the whole run; lists and objects are left to other tables.
Json Facts(const Json& summary) {
  Json facts;
  for (const auto& [key, value] : summary.items()) {
    if (!value.is_structured()) facts[key] = value;
  }
  const Json& seconds = summary.at("seconds_per_frame");
  facts.erase("peak_memory_bytes");
  facts["peak memory, MB"] =
      1e-6 * summary.at("peak_memory_bytes").get<double>();
  facts["seconds per frame, median"] = seconds.at("median");
  facts["seconds per frame, mean"] = seconds.at("mean");
  return facts;
}

/// The headline of an evaluation; empty if there is none.
Json Headline(const ReportedRun& run) {
  return run.evaluation.is_object() ? run.evaluation.value("headline", Json())
                                    : Json();
}

/// Facts and figures of all runs beside one another.
std::string Comparison(const std::vector<ReportedRun>& runs) {
  Json rows = Json::array();
  for (const ReportedRun& run : runs) {
    Json row = {{"run", run.name}};
    const Json facts = Facts(run.summary);
    for (const char* key : {"status", "frames", "lost_frames",
                            "seconds per frame, mean", "peak memory, MB"}) {
      row[key] = facts.value(key, Json());
    }
    // The same columns in all rows, whatever was evaluated.
    for (const ReportedRun& other : runs) {
      const Json figures = Headline(other);
      for (const auto& [key, value] : figures.items()) row[key] = Json();
    }
    const Json figures = Headline(run);
    for (const auto& [key, value] : figures.items()) row[key] = value;
    rows.push_back(row);
  }
  return "<h2>Runs</h2>\n" + RowTable(rows);
}

/// Positions at which a surface was lost.
std::vector<int> LostPositions(const SurfaceCurves& surface) {
  std::vector<int> positions;
  for (std::size_t i = 0; i < surface.states.size(); ++i) {
    if (surface.states[i] == ToString(TrackState::kLost)) {
      positions.push_back(static_cast<int>(i));
    }
  }
  return positions;
}

std::string ChartOf(const CurveGroup& group, std::vector<int> marks,
                    const std::vector<int>& frames) {
  marks.insert(marks.end(), group.not_finite.begin(), group.not_finite.end());
  return SvgChart({group.title, group.series, marks, group.stacked, frames});
}

/// Which surface was in which state when.
std::string States(const RunCurves& curves) {
  std::vector<Strip> strips;
  for (const SurfaceCurves& surface : curves.surfaces) {
    strips.push_back(
        {surface.name.substr(0, surface.name.find('_')), surface.states});
  }
  std::vector<std::string> values;
  for (const TrackState state :
       {TrackState::kTracked, TrackState::kLost, TrackState::kOccluded,
        TrackState::kInactive}) {
    values.push_back(ToString(state));
  }
  return SvgStrips(strips, values, curves.frames);
}

std::string Charts(const RunCurves& curves) {
  std::string html = Heading("States and seconds over the frames") +
                     "<div class=\"charts\">" + States(curves) +
                     ChartOf(curves.seconds, {}, curves.frames) + "</div>\n";
  for (const SurfaceCurves& surface : curves.surfaces) {
    html += Heading(surface.name) + "<div class=\"charts\">";
    for (const CurveGroup& group : surface.groups) {
      html += ChartOf(group, LostPositions(surface), curves.frames);
    }
    html += "</div>\n";
  }
  return html;
}

/// A picture as part of the page; one that cannot be read says so.
std::string Picture(const std::string& path) {
  const std::string frame =
      "frame " + std::to_string(std::atoi(
                     std::filesystem::path(path).filename().string().c_str()));
  cv::Mat image = cv::imread(path);
  if (image.empty()) return "<p>" + frame + ": cannot be read</p>\n";
  if (image.cols > kPictureWidth) {
    const double scale = double(kPictureWidth) / image.cols;
    cv::resize(image, image, {}, scale, scale, cv::INTER_AREA);
  }
  std::vector<uchar> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
  return "<figure><img alt=\"" + frame + "\" src=\"data:image/jpeg;base64," +
         Base64(bytes.data(), bytes.size()) + "\"><figcaption>" + frame +
         "</figcaption></figure>\n";
}

std::string Pictures(const std::vector<std::string>& paths) {
  if (paths.empty()) return "";
  const std::size_t count = std::min(paths.size(), kPictures);
  std::string html = Heading("Pictures");
  if (count < paths.size()) {
    html += "<p>" + std::to_string(count) + " of " +
            std::to_string(paths.size()) + "</p>\n";
  }
  for (std::size_t k = 0; k < count; ++k) {
    // Spread over all, the first and the last one among them.
    html +=
        Picture(paths[count < 2 ? 0 : k * (paths.size() - 1) / (count - 1)]);
  }
  return html;
}

std::string RunSection(const ReportedRun& run) {
  std::string html = "<section><h2>" + HtmlEscaped(run.name) + "</h2>\n" +
                     KeyTable(Facts(run.summary));
  const Json figures = Headline(run);
  if (!figures.empty()) html += Heading("Evaluation") + KeyTable(figures);
  html +=
      Heading("Surfaces") + RowTable(WithoutLists(run.summary.at("surfaces")));
  html += Charts(run.curves) + Pictures(run.pictures);
  if (!run.options.empty()) {
    html += Details("Energy and all options", KeyTable(run.options));
  }
  html += Details("Versions", KeyTable(run.summary.at("versions")));
  return html + "</section>\n";
}

std::vector<std::string> MontagesOf(const RunPaths& paths) {
  std::error_code missing;
  std::set<std::string> found;
  for (const auto& entry :
       std::filesystem::directory_iterator(paths.Pictures(), missing)) {
    if (entry.path().filename().string().find("_montage.png") !=
        std::string::npos) {
      found.insert(entry.path().string());
    }
  }
  return {found.begin(), found.end()};
}

/// Name of a run's folder; before it is in its place it is within that.
std::string NameOf(const RunPaths& paths) {
  const std::filesystem::path root(paths.root());
  const std::filesystem::path parent = root.parent_path();
  const bool unfinished = RunPaths(parent.string()).Unfinished() == root;
  return (unfinished ? parent : root).filename().string();
}

ReportedRun RunOf(const RunPaths& paths, const Json& summary) {
  ReportedRun run;
  run.name = NameOf(paths);
  run.summary = summary;
  const Json marker = ReadJsonOrNull(paths.Marker());
  if (marker.is_object()) run.options = marker.value("identity_parts", Json());
  run.evaluation = ReadJsonOrNull(paths.Evaluation());
  run.curves =
      GatherCurves(ReadJsonLines(paths.Frames()), summary.at("surfaces"));
  run.pictures = MontagesOf(paths);
  return run;
}

}  // namespace

ReportedRun ReadReportedRun(const RunPaths& paths) {
  const Json summary = ReadJsonOrNull(paths.Summary());
  if (!summary.is_object()) {
    throw InputError(paths.Summary() +
                     ": expected the summary of a run that has ended");
  }
  for (const char* key :
       {"surfaces", "seconds_per_frame", "peak_memory_bytes", "versions"}) {
    if (!summary.contains(key)) {
      throw InputError(paths.Summary() + ": has no '" + key +
                       "': expected the summary of a run of this version");
    }
  }
  try {
    return RunOf(paths, summary);
  } catch (const Json::exception& error) {
    throw InputError(
        paths.Frames() +
        ": not as a run of this version writes it: " + error.what());
  }
}

std::string HtmlReport(const std::vector<ReportedRun>& runs) {
  std::string html = kHead;
  html += "<h1>SplitFusion report</h1>\n";
  if (runs.size() > 1) html += Comparison(runs);
  for (const ReportedRun& run : runs) html += RunSection(run);
  return html + "</body></html>\n";
}

void WriteHtmlReport(const RunPaths& paths, const Json& summary) {
  const std::string html = HtmlReport({RunOf(paths, summary)});
  WriteFileAtomically(paths.HtmlReport(),
                      [&](std::ostream& out) { out << html; });
}

}  // namespace splitfusion
