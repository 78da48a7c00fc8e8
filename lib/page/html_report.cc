#include "splitfusion/lib/page/html_report.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/base64.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/page/html_page.h"
#include "splitfusion/lib/page/html_tables.h"
#include "splitfusion/lib/page/run_comparison.h"
#include "splitfusion/lib/page/run_scene.h"
#include "splitfusion/lib/page/svg_chart.h"
#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Of more runs on one page the charts of each are left out.
constexpr std::size_t kFullRuns = 4;  // Layout.
/// Pictures of a run that are shown, and their width, pixels.
constexpr std::size_t kPictures = 24;  // Layout.
constexpr int kPictureWidth = 800;     // Layout.

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

void AddChart(const CurveGroup& group, std::vector<int> marks,
              const ReportedRun& run, HtmlPage* page) {
  marks.insert(marks.end(), group.not_finite.begin(), group.not_finite.end());
  page->AddChart(
      {group.title, group.series, marks, group.stacked, run.curves.frames},
      run.name);
}

/// What was decided of a surface, as marks on its strip; what has no surface
/// yet is on that of the background.
std::vector<StripMark> MarksOf(int surface, const RunCurves& curves) {
  std::vector<StripMark> marks;
  for (const RunEvent& event : curves.events) {
    if (event.surface != surface) continue;
    const auto found = std::lower_bound(curves.frames.begin(),
                                        curves.frames.end(), event.frame);
    if (found == curves.frames.end()) continue;
    marks.push_back({static_cast<int>(found - curves.frames.begin()),
                     "frame " + std::to_string(event.frame) + ": " +
                         event.class_name + " " + event.what});
  }
  return marks;
}

/// Which surface was in which state when, and what was decided.
std::string States(const RunCurves& curves) {
  std::vector<Strip> strips;
  for (const SurfaceCurves& surface : curves.surfaces) {
    const std::string id = surface.name.substr(0, surface.name.find('_'));
    strips.push_back({id, surface.states, MarksOf(std::stoi(id), curves)});
  }
  std::vector<std::string> values;
  for (const TrackState state :
       {TrackState::kTracked, TrackState::kLost, TrackState::kOccluded,
        TrackState::kInactive}) {
    values.push_back(ToString(state));
  }
  return SvgStrips(strips, values, curves.frames);
}

/// What was decided when.
std::string Events(const std::vector<RunEvent>& events) {
  Json rows = Json::array();
  for (const RunEvent& event : events) {
    rows.push_back({{"frame", event.frame},
                    {"what", event.what},
                    {"surface", event.surface},
                    {"class", event.class_name}});
  }
  return Details("Decisions (" + std::to_string(events.size()) + ")",
                 RowTable(rows));
}

void AddCharts(const ReportedRun& run, HtmlPage* page) {
  const RunCurves& curves = run.curves;
  page->Add(Heading("States, decisions and seconds over the frames") +
            "<div class=\"charts\">" + States(curves));
  AddChart(curves.seconds, {}, run, page);
  page->Add("</div>\n" + Events(curves.events));
  for (const SurfaceCurves& surface : curves.surfaces) {
    page->Add(Heading(surface.name) + "<div class=\"charts\">");
    for (const CurveGroup& group : surface.groups) {
      AddChart(group, LostPositions(surface), run, page);
    }
    page->Add("</div>\n");
  }
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
  std::string html = Heading("Pictures") + "<div class=\"pictures\">";
  if (count < paths.size()) {
    html += "<p>" + std::to_string(count) + " of " +
            std::to_string(paths.size()) + "</p>\n";
  }
  for (std::size_t k = 0; k < count; ++k) {
    // Spread over all, the first and the last one among them.
    html +=
        Picture(paths[count < 2 ? 0 : k * (paths.size() - 1) / (count - 1)]);
  }
  return html + "</div>\n";
}

/// Options beside their defaults, those first that are others.
std::string Options(const ReportedRun& run) {
  if (run.options.empty()) return "";
  std::string html;
  if (run.defaults.is_object()) {
    Json rows = Json::array();
    for (const auto& [name, value] : run.defaults.items()) {
      rows.push_back({{"option", name},
                      {"value", run.options.value(name, Json())},
                      {"default", value == "" ? Json() : value}});
    }
    html += Heading("Options that differ from the defaults") + RowTable(rows);
  }
  return html + Details("Energy and all options", KeyTable(run.options));
}

void AddViewer(const ReportedRun& run, HtmlPage* page,
               std::vector<std::string>* left_out) {
  try {
    page->AddViewer(SceneOfRun(run), run.name);
  } catch (const InputError& error) {
    page->Add("<p>No viewer: " + HtmlEscaped(error.what()) + "</p>\n");
    if (left_out != nullptr) left_out->push_back(error.what());
  }
}

/// A run with all its charts; without them if `brief`.
void AddRun(const ReportedRun& run, const ReportContent& content, bool brief,
            HtmlPage* page, std::vector<std::string>* left_out) {
  page->Add("<section><h2>" + HtmlEscaped(run.name) + "</h2>\n" +
            KeyTable(FactsOf(run)));
  const Json figures = HeadlineOf(run);
  if (!figures.empty()) page->Add(Heading("Evaluation") + KeyTable(figures));
  page->Add(Options(run) + Heading("Surfaces") +
            RowTable(WithoutLists(run.summary.at("surfaces"))));
  if (content.viewer) AddViewer(run, page, left_out);
  if (!brief) AddCharts(run, page);
  if (content.pictures) page->Add(Pictures(run.pictures));
  page->Add(Details("Versions", KeyTable(run.summary.at("versions"))) +
            "</section>\n");
}

}  // namespace

std::string HtmlReport(const std::vector<ReportedRun>& runs,
                       const ReportContent& content,
                       const std::vector<ReportedSolvers>& solvers,
                       std::vector<std::string>* left_out) {
  HtmlPage page;
  page.Add("<h1>SplitFusion report</h1>\n");
  if (runs.size() > 1) AddComparison(runs, &page);
  for (const ReportedRun& run : runs) {
    AddRun(run, content, runs.size() > kFullRuns, &page, left_out);
  }
  for (const ReportedSolvers& one : solvers) {
    page.Add("<h2>" + HtmlEscaped(one.name) + "</h2>\n<div class=\"charts\">");
    for (const std::string& figure : one.figures) {
      page.Add("<figure class=\"paper\">" + figure + "</figure>\n");
    }
    page.Add("</div>\n");
  }
  return page.Text();
}

void WriteHtmlReport(const RunPaths& paths, const Json& summary) {
  const std::string html = HtmlReport({ReportedRunOf(paths, summary)});
  WriteFileAtomically(paths.HtmlReport(),
                      [&](std::ostream& out) { out << html; });
}

}  // namespace splitfusion
