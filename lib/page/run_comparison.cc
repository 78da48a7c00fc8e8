#include "splitfusion/lib/page/run_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include "splitfusion/lib/page/html_tables.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Facts and figures of all runs beside one another.
std::string Comparison(const std::vector<ReportedRun>& runs) {
  Json rows = Json::array();
  for (const ReportedRun& run : runs) {
    Json row = {{"run", run.name}};
    const Json facts = FactsOf(run);
    for (const char* key : {"status", "frames", "lost_frames",
                            "seconds per frame, mean", "peak memory, MB"}) {
      row[key] = facts.value(key, Json());
    }
    // The same columns in all rows, whatever was evaluated.
    for (const ReportedRun& other : runs) {
      const Json figures = HeadlineOf(other);
      for (const auto& [key, value] : figures.items()) row[key] = Json();
    }
    const Json figures = HeadlineOf(run);
    for (const auto& [key, value] : figures.items()) row[key] = value;
    rows.push_back(row);
  }
  return "<h2>Runs</h2>\n" + RowTable(rows);
}

/// Frames of all runs, ascending.
std::vector<int> AllFrames(const std::vector<ReportedRun>& runs) {
  std::set<int> frames;
  for (const ReportedRun& run : runs) {
    frames.insert(run.curves.frames.begin(), run.curves.frames.end());
  }
  return {frames.begin(), frames.end()};
}

/// The curve of a group over `frames`; of parts of a whole their sum.
std::vector<double> WholeOf(const CurveGroup& group,
                            const std::vector<int>& own,
                            const std::vector<int>& frames) {
  std::vector<double> values(frames.size(),
                             std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < own.size(); ++i) {
    double& value =
        values[std::lower_bound(frames.begin(), frames.end(), own[i]) -
               frames.begin()];
    for (const ChartSeries& series : group.series) {
      if (!std::isfinite(series.values[i])) continue;
      value = std::isnan(value) ? series.values[i] : value + series.values[i];
    }
  }
  return values;
}

using GroupOf = std::function<const CurveGroup*(const ReportedRun&)>;

/// One quantity of all runs that have it, a line each.
void AddOverRuns(const std::vector<ReportedRun>& runs,
                 const std::vector<int>& frames, const GroupOf& group_of,
                 HtmlPage* page) {
  Chart chart;
  for (const ReportedRun& run : runs) {
    const CurveGroup* group = group_of(run);
    if (group == nullptr) continue;
    // Of parts of a whole their sum is shown.
    chart.title = group->title.substr(0, group->title.find(", by "));
    chart.series.push_back(
        {run.name, WholeOf(*group, run.curves.frames, frames)});
  }
  chart.frames = frames;
  page->AddChart(chart, "all runs");
}

const SurfaceCurves* FindSurface(const ReportedRun& run,
                                 const std::string& name) {
  for (const SurfaceCurves& surface : run.curves.surfaces) {
    if (surface.name == name) return &surface;
  }
  return nullptr;
}

/// Charts of a surface that several runs have.
void AddSurface(const std::vector<ReportedRun>& runs, const std::string& name,
                const std::vector<int>& frames, HtmlPage* page) {
  const auto has = [&](const ReportedRun& run) {
    return FindSurface(run, name) != nullptr;
  };
  if (std::count_if(runs.begin(), runs.end(), has) < 2) return;
  const auto first = std::find_if(runs.begin(), runs.end(), has);
  const std::size_t groups = FindSurface(*first, name)->groups.size();
  page->Add(Heading(name + ", by run") + "<div class=\"charts\">");
  for (std::size_t g = 0; g < groups; ++g) {
    AddOverRuns(
        runs, frames,
        [&](const ReportedRun& run) {
          const SurfaceCurves* surface = FindSurface(run, name);
          return surface == nullptr ? nullptr : &surface->groups[g];
        },
        page);
  }
  page->Add("</div>\n");
}

}  // namespace

Json FactsOf(const ReportedRun& run) {
  const Json& summary = run.summary;
  Json facts;
  for (const auto& [key, value] : summary.items()) {
    if (!value.is_structured()) facts[key] = value;
  }
  const Json& seconds = summary.at("seconds_per_frame");
  facts.erase("format_version");
  facts.erase("peak_memory_bytes");
  facts["peak memory, MB"] =
      1e-6 * summary.at("peak_memory_bytes").get<double>();
  facts["seconds per frame, median"] = seconds.at("median");
  facts["seconds per frame, mean"] = seconds.at("mean");
  return facts;
}

Json HeadlineOf(const ReportedRun& run) {
  return run.evaluation.is_object() ? run.evaluation.value("headline", Json())
                                    : Json();
}

void AddComparison(const std::vector<ReportedRun>& runs, HtmlPage* page) {
  page->Add(Comparison(runs) + "<div class=\"charts\">");
  const std::vector<int> frames = AllFrames(runs);
  AddOverRuns(
      runs, frames, [](const ReportedRun& run) { return &run.curves.seconds; },
      page);
  page->Add("</div>\n");
  std::set<std::string> names;
  for (const ReportedRun& run : runs) {
    for (const SurfaceCurves& surface : run.curves.surfaces) {
      names.insert(surface.name);
    }
  }
  for (const std::string& name : names) AddSurface(runs, name, frames, page);
}

}  // namespace splitfusion
