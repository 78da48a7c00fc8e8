#include "splitfusion/pipelines/batch_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/report/csv_row.h"
#include "splitfusion/lib/report/report_json.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

/// Null if the file is missing or broken: such a run has no figures.
Json ReadJson(const std::string& path) {
  std::ifstream stream(path);
  Json value = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  return value.is_discarded() ? Json() : value;
}

double Figure(const Json& value, const char* pointer) {
  const Json::json_pointer at(pointer);
  if (!value.is_object() || !value.contains(at)) return BatchFigures::kNone;
  const Json& item = value.at(at);
  return item.is_number() ? item.get<double>() : BatchFigures::kNone;
}

/// Mean of the values that are known.
double MeanFigure(const std::vector<double>& values) {
  double sum = 0;
  int count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : BatchFigures::kNone;
}

/// View error of an instance over all its pixels in all frames.
struct PooledView {
  double pixels = 0;   ///< Of the instance.
  double covered = 0;  ///< Of these, with a model.
  double sum = 0;      ///< Of the distances, metres.
  double near = 0;     ///< Pixels with a model within 20 mm.
};

PooledView PoolView(const Json& instance) {
  PooledView view;
  if (!instance.contains("frames")) return view;
  for (const Json& frame : instance["frames"]) {
    const double pixels = Figure(frame, "/view/pixels");
    const double covered = Figure(frame, "/view/distances/count");
    const double mean = Figure(frame, "/view/distances/mean");
    const double within = Figure(frame, "/view/distances/within/0.02");
    if (!std::isfinite(pixels + covered + mean + within)) continue;
    view.pixels += pixels;
    view.covered += covered;
    view.sum += covered * mean;
    view.near += covered * within;
  }
  return view;
}

void ReadObjects(const Json& evaluation, BatchFigures* figures) {
  std::vector<double> view, near, uncovered, accuracy, f_score;
  const Json instances = evaluation.is_object()
                             ? evaluation.value("instances", Json::array())
                             : Json::array();
  for (const Json& item : instances) {
    const PooledView pool = PoolView(item);
    view.push_back(pool.sum / pool.covered);
    near.push_back(pool.near / pool.pixels);
    uncovered.push_back(1 - pool.covered / pool.pixels);
    accuracy.push_back(Figure(item, "/surface/accuracy/mean"));
    f_score.push_back(Figure(item, "/surface/f_score/0.02"));
  }
  figures->objects_view_m = MeanFigure(view);
  figures->objects_right = MeanFigure(near);
  figures->objects_uncovered = MeanFigure(uncovered);
  figures->objects_accuracy_m = MeanFigure(accuracy);
  figures->objects_f_score = MeanFigure(f_score);
}

void ReadErrors(const Json& evaluation, BatchFigures* figures) {
  figures->ate_rmse_m = Figure(evaluation, "/ate/rmse");
  figures->background_accuracy_m =
      Figure(evaluation, "/background/accuracy/mean");
  figures->background_completeness =
      Figure(evaluation, "/background/completeness/within/0.02");
  figures->track_median_m = Figure(evaluation, "/tracks/visible/median");
  figures->track_mean_m = Figure(evaluation, "/tracks/visible/mean");
  ReadObjects(evaluation, figures);
}

Json ToJson(const BatchResult& result) {
  Json object = {
      {"sequence", result.run.sequence}, {"options", result.run.options},
      {"folder", result.run.folder},     {"skipped", result.skipped},
      {"exit_code", result.exit_code},   {"error", result.error}};
  for (const BatchColumn& column : kBatchColumns) {
    object[column.name] = result.figures.*column.figure;
  }
  return object;
}

std::string CsvText(const std::vector<BatchResult>& results) {
  CsvRow head;
  for (const auto* name :
       {"sequence", "options", "folder", "skipped", "exit_code", "error"}) {
    head.Add(std::string(name));
  }
  for (const auto& column : kBatchColumns) head.Add(std::string(column.name));
  std::string text = head.text() + "\n";
  for (const BatchResult& result : results) {
    CsvRow row;
    row.Add(result.run.sequence).Add(result.run.options);
    row.Add(result.run.folder).Add(result.skipped ? 1 : 0);
    row.Add(result.exit_code).Add(result.error);
    for (const auto& column : kBatchColumns) {
      row.Add(result.figures.*column.figure);
    }
    text += row.text() + "\n";
  }
  return text;
}

std::string Formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

Row TableRow(const BatchResult& result) {
  const BatchFigures& figures = result.figures;
  return {result.run.sequence,
          result.run.options,
          std::to_string(result.exit_code) + (result.skipped ? " (kept)" : ""),
          Formatted("%.4f", figures.ate_rmse_m),
          Formatted("%.0f", figures.frames),
          Formatted("%.0f", figures.lost_frames),
          Formatted("%.2f", figures.seconds_median),
          Formatted("%.0f", figures.peak_memory_bytes / (1 << 20)),
          result.error};
}

std::string Aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

BatchFigures ReadFigures(const std::string& run_folder) {
  const RunPaths paths(run_folder);
  const Json summary = ReadJson(paths.Summary());
  const Json evaluation = ReadJson(paths.Evaluation());
  BatchFigures figures;
  figures.frames = Figure(summary, "/frames");
  figures.lost_frames = Figure(summary, "/lost_frames");
  figures.seconds_median = Figure(summary, "/seconds_per_frame/median");
  figures.seconds_mean = Figure(summary, "/seconds_per_frame/mean");
  figures.peak_memory_bytes = Figure(summary, "/peak_memory_bytes");
  ReadErrors(evaluation, &figures);
  return figures;
}

Json ToJson(const std::vector<BatchResult>& results) {
  Json list = Json::array();
  for (const BatchResult& result : results) list.push_back(ToJson(result));
  return list;
}

void WriteBatchSummary(const std::string& folder,
                       const std::vector<BatchResult>& results) {
  const std::filesystem::path path(folder);
  WriteFileAtomically((path / "summary.csv").string(),
                      [&](std::ostream& out) { out << CsvText(results); });
  WriteFileAtomically((path / "summary.json").string(), [&](std::ostream& out) {
    out << JsonText(ToJson(results), 2) << '\n';
  });
}

std::string FormatBatchTable(const std::vector<BatchResult>& results) {
  std::vector<Row> rows = {{"sequence", "options", "exit", "ATE [m]", "frames",
                            "lost", "s/frame", "MiB", "error"}};
  for (const BatchResult& result : results) rows.push_back(TableRow(result));
  return Aligned(rows);
}

}  // namespace splitfusion
