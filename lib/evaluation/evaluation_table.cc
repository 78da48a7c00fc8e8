#include "splitfusion/lib/evaluation/evaluation_table.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/evaluation/mean_error.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"

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
  return cv::format(format, value);
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

std::string NameOf(const InstanceError& instance) {
  return instance.name.empty() ? "instance " + std::to_string(instance.instance)
                               : instance.name;
}

std::string InstanceRows(const InstanceError& instance) {
  const InstanceMeans means = MeanOf(instance);
  const std::string name = NameOf(instance);
  std::string rows;
  if (means.surface_frames > 0) {
    rows += SurfaceRows(name, means.surface);
    rows += "    = surface " + std::to_string(instance.surface_id) + " (" +
            instance.surface_label + "), judged in " +
            std::to_string(means.surface_frames) + " of " +
            std::to_string(instance.frames.size()) + " frames with truth" +
            (means.frames_missing > 0
                 ? ", missing in " + std::to_string(means.frames_missing)
                 : "") +
            "\n";
  }
  if (means.view_frames > 0) {
    rows += DistancesRow(name + " view", means.view.distances);
    rows += "    model missing at " + std::to_string(means.view.uncovered) +
            " of " + std::to_string(means.view.pixels) + " pixels\n";
  }
  return rows;
}

std::string Percent(double share) { return Number(100 * share, "%9.2f"); }

/// A percentage, or a dash.
std::string PercentOrDash(const std::optional<double>& share) {
  return share ? Percent(*share) : std::string(8, ' ') + "-";
}

/// Who is missing, and how much of what was seen is there; empty if nothing of
/// that is known.
std::string PresenceTable(const std::vector<InstanceError>& instances) {
  std::string rows;
  for (const InstanceError& instance : instances) {
    if (!instance.presence && !instance.seen) continue;
    const InstancePresence presence =
        instance.presence.value_or(InstancePresence());
    const SeenFrame seen = instance.seen.value_or(SeenScore()).Mean();
    rows += Padded(NameOf(instance)) +
            Number(static_cast<double>(presence.in_view.size()), "%9.0f") +
            Number(static_cast<double>(presence.missing.size()), "%9.0f") +
            Percent(presence.MissingShare());
    if (instance.seen) {
      rows += Number(seen.f_score, "%9.4f") + Number(seen.precision, "%9.4f") +
              Number(seen.recall, "%9.4f");
    }
    rows += "\n";
  }
  if (rows.empty()) return "";
  return Head("presence; of what was seen",
              {"in view", "missing", "%", "F 20 mm", "precis.", "recall"}) +
         rows;
}

std::string ShapeTable(const std::vector<SurfaceShape>& shapes) {
  std::string text = Head("model area [%, cm]", {"stretch", "worst", "in frame",
                                                 "edge", "stray", "worst"});
  for (const SurfaceShape& shape : shapes) {
    std::optional<double> stray, worst_stray;
    if (shape.stray) {
      stray = shape.stray->mean;
      worst_stray = shape.stray->worst;
    }
    text +=
        Padded(std::to_string(shape.surface_id) + " " + shape.surface_label) +
        Percent(shape.stretched.mean) + Percent(shape.stretched.worst) +
        Number(shape.stretched.worst_frame, "%9.0f") +
        Number(100 * shape.longest_edge, "%9.1f") + PercentOrDash(stray) +
        PercentOrDash(worst_stray) + "\n";
  }
  return text;
}

std::string TrackRows(const std::string& name, const TrackError& error) {
  const auto row = [&](const std::string& what, const ErrorStatistics& errors) {
    return StatisticsRow(name + " " + what, errors, kMillimetres, "%9.2f");
  };
  return row("visible", error.visible) + row("occluded", error.occluded) +
         row("if still in the world", error.still_world) +
         row("if rigid", error.rigid);
}

/// Which points were followed.
std::string TrackLine(const TrackEvaluation& tracks) {
  return "tracks: " + std::to_string(tracks.errors.points) +
         " points of frame " + std::to_string(tracks.errors.reference_frame) +
         " through " + std::to_string(tracks.errors.frames) + " frames, " +
         std::to_string(tracks.attached) + " attached" +
         (tracks.by_mask ? " with the help of masks\n" : "\n");
}

std::string TrackTable(const TrackEvaluation& tracks,
                       const std::vector<TrackEvaluation>& references) {
  std::string text;
  for (const TrackEvaluation& item : references) text += TrackLine(item);
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
    if (evaluation.ghosts) {
      text += "    ghosts: " + std::to_string(evaluation.ghosts->far) + " of " +
              std::to_string(evaluation.ghosts->vertices) + " vertices, " +
              Number(100 * evaluation.ghosts->Share(), "%.2f %%\n");
    }
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
  add(PresenceTable(evaluation.instances));
  if (!evaluation.shapes.empty()) add(ShapeTable(evaluation.shapes));
  if (evaluation.tracks) {
    add(TrackTable(*evaluation.tracks, evaluation.track_references));
  }
  if (!evaluation.depth.empty()) add(DepthTable(evaluation.depth));
  add(SkippedLines(evaluation.skipped));
  return text;
}

}  // namespace splitfusion
