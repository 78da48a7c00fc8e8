#include "splitfusion/lib/evaluation/evaluation_table.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "splitfusion/lib/evaluation/mean_error.h"

namespace splitfusion {
namespace {

constexpr int kNameWidth = 34;
constexpr double kMillimetres = 1000;

std::string Padded(std::string name) {
  name.insert(0, 2, ' ');
  if (name.size() < kNameWidth) name.resize(kNameWidth, ' ');
  return name;
}

std::string Number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

std::string Head(const std::string& title,
                 const std::vector<std::string>& columns) {
  std::string line = title;
  line.resize(std::max<std::size_t>(kNameWidth, title.size()), ' ');
  for (const std::string& column : columns) {
    line += std::string(9 - column.size(), ' ') + column;
  }
  return line + "\n";
}

std::string Row(const std::string& name, const std::vector<double>& values,
                const char* format) {
  std::string line = Padded(name);
  for (const double value : values) line += Number(value, format);
  return line + "\n";
}

std::string StatisticsRow(const std::string& name,
                          const ErrorStatistics& errors, double unit,
                          const char* format) {
  return Row(name,
             {errors.rmse * unit, errors.mean * unit, errors.median * unit,
              errors.p90 * unit, errors.max * unit},
             format);
}

std::string DistancesRow(const std::string& name,
                         const SurfaceDistances& distances) {
  const ErrorStatistics& errors = distances.statistics;
  std::string line = Padded(name);
  for (const double value : {errors.mean, errors.median, errors.p90}) {
    line += Number(value * kMillimetres, "%9.2f");
  }
  for (const double value : distances.within) line += Number(value, "%9.4f");
  return line + "\n";
}

std::string SurfaceHead() {
  return Head("surfaces [mm, fractions]",
              {"mean", "median", "p90", "<10 mm", "<20 mm", "<50 mm"});
}

std::string SurfaceRows(const std::string& name, const SurfaceError& error) {
  std::string rows = DistancesRow(name + " accuracy", error.accuracy) +
                     DistancesRow(name + " completeness", error.completeness);
  rows += Padded(name + " F-score") + std::string(27, ' ');
  for (const double value : error.f_score) rows += Number(value, "%9.4f");
  return rows + "\n";
}

std::string InstanceRows(const InstanceError& instance) {
  const InstanceMeans means = MeanOf(instance);
  const std::string name = instance.name.empty()
                               ? "instance " + std::to_string(instance.instance)
                               : instance.name;
  std::string rows;
  if (means.surface_frames > 0) {
    rows += SurfaceRows(name, means.surface);
    rows += "    = surface " + std::to_string(instance.surface_id) + " (" +
            instance.surface_label + "), tracked in " +
            std::to_string(means.surface_frames) + " of " +
            std::to_string(instance.frames.size()) + " frames with truth\n";
  }
  if (means.view_frames > 0) {
    rows += DistancesRow(name + " view", means.view.distances);
    rows += "    model missing at " + std::to_string(means.view.uncovered) +
            " of " + std::to_string(means.view.pixels) + " pixels\n";
  }
  return rows;
}

std::string TrackRows(const std::string& name, const TrackError& error) {
  const auto row = [&](const std::string& what, const ErrorStatistics& errors) {
    return StatisticsRow(name + " " + what, errors, kMillimetres, "%9.2f");
  };
  return row("visible", error.visible) + row("occluded", error.occluded) +
         row("if still in the world", error.still_world) +
         row("if rigid", error.rigid);
}

std::string TrackTable(const TrackEvaluation& tracks) {
  std::string text =
      "tracks: " + std::to_string(tracks.errors.points) + " points of frame " +
      std::to_string(tracks.errors.reference_frame) + " through " +
      std::to_string(tracks.errors.frames) + " frames, " +
      std::to_string(tracks.attached) + " attached" +
      (tracks.by_mask ? " with the help of masks\n" : "\n");
  text += Head("tracks [mm]", {"rmse", "mean", "median", "p90", "max"});
  text += TrackRows("all", tracks.errors.all);
  if (tracks.errors.instances.size() < 2) return text;
  for (const auto& [instance, error] : tracks.errors.instances) {
    text += TrackRows("instance " + std::to_string(instance), error);
  }
  return text;
}

std::string DepthTable(const std::vector<DepthAgreement>& surfaces) {
  std::string text = Head("model - live depth [mm, fraction]",
                          {"median", "p90", "missing", "frames"});
  for (const DepthAgreement& item : surfaces) {
    text += Padded(std::to_string(item.surface_id) + " " + item.surface_label) +
            Number(item.distances.median * kMillimetres, "%9.2f") +
            Number(item.distances.p90 * kMillimetres, "%9.2f") +
            Number(item.UncoveredFraction(), "%9.4f") +
            Number(item.frames, "%9.0f") + "\n";
  }
  return text;
}

/// Surfaces against the truth; empty if there are none.
std::string SurfaceTable(const RunEvaluation& evaluation) {
  if (!evaluation.background && evaluation.instances.empty()) return "";
  std::string text = SurfaceHead();
  if (evaluation.background) {
    text += SurfaceRows("background", *evaluation.background);
  }
  for (const InstanceError& instance : evaluation.instances) {
    text += InstanceRows(instance);
  }
  return text;
}

std::string SkippedLines(const std::vector<std::string>& skipped) {
  std::string text;
  for (const std::string& item : skipped) text += "skipped: " + item + "\n";
  return text;
}

}  // namespace

std::string FormatTable(const TrajectoryError& error) {
  std::string text = "trajectory: " + std::to_string(error.matched) + " of " +
                     std::to_string(error.estimated_poses) +
                     " poses matched, path " +
                     Number(error.path_length, "%.3f m\n");
  text += Head("trajectory", {"rmse", "mean", "median", "p90", "max"});
  text += StatisticsRow("ATE [mm]", error.absolute, kMillimetres, "%9.2f");
  for (const RelativePoseError& item : error.relative) {
    const std::string name = "RPE " + std::to_string(item.frames) +
                             (item.frames == 1 ? " frame " : " frames ");
    text +=
        StatisticsRow(name + "[mm]", item.translation, kMillimetres, "%9.2f");
    text += StatisticsRow(name + "[deg]", item.rotation_degrees, 1, "%9.4f");
  }
  return text;
}

std::string FormatTable(const std::string& name, const SurfaceError& error) {
  return SurfaceHead() + SurfaceRows(name, error);
}

std::string FormatTable(const RunEvaluation& evaluation) {
  std::string text;
  const auto add = [&text](const std::string& table) {
    if (!text.empty() && !table.empty()) text += "\n";
    text += table;
  };
  if (evaluation.trajectory) add(FormatTable(*evaluation.trajectory));
  add(SurfaceTable(evaluation));
  if (evaluation.tracks) add(TrackTable(*evaluation.tracks));
  if (!evaluation.depth.empty()) add(DepthTable(evaluation.depth));
  add(SkippedLines(evaluation.skipped));
  return text;
}

}  // namespace splitfusion
