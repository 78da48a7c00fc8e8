#include "splitfusion/lib/report/run_summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

bool AnyLost(const FrameReport& report) {
  return std::any_of(report.surfaces.begin(), report.surfaces.end(),
                     [](const auto& s) { return s.state == "lost"; });
}

Json ToJson(const SurfaceSummary& surface) {
  return {{"id", surface.id},
          {"label", surface.label},
          {"kind", ToString(surface.kind)},
          {"first_frame", surface.first_frame},
          {"frames", surface.frames},
          {"nodes", surface.nodes},
          {"node_spacing", surface.node_spacing},
          {"vertices", surface.vertices},
          {"lost", surface.lost},
          {"hidden", surface.hidden}};
}

Json SecondsPerFrame(const RunSummary& summary) {
  Json parts;
  for (std::size_t i = 0; i < kFrameParts.size(); ++i) {
    parts[kFrameParts[i].name] = summary.part_seconds[i];
  }
  return {{"median", summary.median_seconds},
          {"mean", summary.mean_seconds},
          {"parts", parts}};
}

}  // namespace

Json ToJson(const RunSummary& summary) {
  Json surfaces = Json::array();
  for (const auto& item : summary.surfaces) surfaces.push_back(ToJson(item));
  return {{"complete", summary.complete},
          {"preset", summary.preset},
          {"frames", summary.frames},
          {"lost_frames", summary.lost_frames},
          {"seconds_per_frame", SecondsPerFrame(summary)},
          {"seconds_writing", summary.seconds_writing},
          {"peak_memory_bytes", summary.peak_memory_bytes},
          {"surfaces", surfaces},
          {"versions", Json(summary.versions)}};
}

void SummaryBuilder::Add(const FrameReport& report) {
  if (AnyLost(report)) ++lost_frames_;
  seconds_.push_back(report.total_seconds);
  for (std::size_t i = 0; i < kFrameParts.size(); ++i) {
    part_sums_[i] += report.*kFrameParts[i].seconds;
  }
  for (const SurfaceReport& surface : report.surfaces) {
    AddSurface(report.frame, surface);
  }
}

void SummaryBuilder::AddSurface(int frame, const SurfaceReport& report) {
  if (report.state == "dropped") {  // It begins anew, under the same id.
    surfaces_.erase(report.id);
    return;
  }
  const auto [found, is_new] = surfaces_.try_emplace(report.id);
  SurfaceSummary& surface = found->second;
  if (is_new) surface.first_frame = frame;
  surface.id = report.id;
  surface.label = report.label;
  surface.kind = report.kind;
  if (report.state == "tracked" || report.state == "born") ++surface.frames;
  if (report.state == "lost") surface.lost.push_back(frame);
  if (report.state == "hidden") surface.hidden.push_back(frame);
  if (report.nodes > 0) {
    surface.nodes = report.nodes;
    surface.node_spacing = report.node_spacing;
  }
  if (report.vertices > 0) surface.vertices = report.vertices;
}

void SummaryBuilder::SetSurfaceSize(int id, int nodes, int vertices) {
  const auto found = surfaces_.find(id);
  if (found == surfaces_.end()) return;
  found->second.nodes = nodes;
  found->second.vertices = vertices;
}

RunSummary SummaryBuilder::Build() const {
  RunSummary summary;
  summary.frames = static_cast<int>(seconds_.size());
  summary.lost_frames = lost_frames_;
  const double count = std::max(1, summary.frames);
  summary.median_seconds = Median(seconds_);
  summary.mean_seconds =
      std::accumulate(seconds_.begin(), seconds_.end(), 0.0) / count;
  for (std::size_t i = 0; i < part_sums_.size(); ++i) {
    summary.part_seconds[i] = part_sums_[i] / count;
  }
  for (const auto& [id, surface] : surfaces_) {
    summary.surfaces.push_back(surface);
  }
  return summary;
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  if (values.size() % 2 == 1) return values[middle];
  return 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace splitfusion
