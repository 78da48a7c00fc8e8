#include "splitfusion/lib/report/run_summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/report/report_json.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

bool AnyIs(TrackState state, const FrameReport& report) {
  return std::any_of(report.surfaces.begin(), report.surfaces.end(),
                     [&](const auto& s) { return s.state == state; });
}

/// "3 frames", "1 frame".
std::string Frames(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " frame" : " frames");
}

/// What is to be said of a surface that was lost or occluded; else empty.
std::string Trouble(const SurfaceSummary& surface) {
  std::string text;
  const auto add = [&text](const std::string& what) {
    if (!text.empty()) text += ", ";
    text += what;
  };
  if (!surface.lost.empty()) add("lost in " + Frames(surface.lost.size()));
  if (!surface.occluded.empty()) {
    add("occluded in " + Frames(surface.occluded.size()));
  }
  if (text.empty()) return text;
  if (surface.away_since >= 0) {
    add("not found again since frame " + std::to_string(surface.away_since));
  } else if (!surface.refound.empty()) {
    add("found again");
  }
  return "; " + std::to_string(surface.id) + " " + surface.label + " " + text;
}

Json ToJson(const SurfaceSummary& surface) {
  Json json = {{"id", surface.id},
               {"label", surface.label},
               {"kind", ToString(surface.kind)},
               {"first_frame", surface.first_frame},
               {"frames", surface.frames},
               {"nodes", surface.nodes},
               {"node_spacing", surface.node_spacing},
               {"vertices", surface.vertices},
               {"lost", surface.lost},
               {"occluded", surface.occluded},
               {"lost_frames", surface.lost.size()},
               {"occluded_frames", surface.occluded.size()},
               {"refound_frames", surface.refound.size()},
               {"refound", surface.refound},
               {"reanchored", surface.reanchored},
               {"relocalized", surface.relocalized},
               {"away_since",
                surface.away_since >= 0 ? Json(surface.away_since) : Json()}};
  if (surface.stretched) json["stretched"] = *surface.stretched;
  if (surface.hold) json["hold"] = *surface.hold;
  return json;
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

Json ToJson(const LoopReport& loops) {
  return {{"key_frames", loops.key_frames},
          {"compared", loops.compared},
          {"found", loops.found},
          {"kept", loops.kept},
          {"misfit_before", loops.misfit_before},
          {"misfit_after", loops.misfit_after},
          {"largest_drift", loops.largest_drift},
          {"largest_change", loops.largest_change},
          {"largest_shift", loops.largest_shift},
          {"largest_turn", loops.largest_turn},
          {"fused_anew", loops.fused_anew}};
}

}  // namespace

std::string VerdictLine(const RunSummary& summary) {
  std::string troubles;
  for (const SurfaceSummary& surface : summary.surfaces) {
    troubles += Trouble(surface);
  }
  const std::size_t surfaces = summary.surfaces.size();
  return std::string(summary.complete ? "" : "incomplete: ") +
         Frames(summary.frames) + ", " + std::to_string(surfaces) +
         (surfaces == 1 ? " surface" : " surfaces") +
         (troubles.empty() ? ", none lost or occluded" : troubles);
}

std::vector<std::string> HoldLines(const RunSummary& summary) {
  std::vector<std::string> lines;
  for (const SurfaceSummary& surface : summary.surfaces) {
    if (!surface.hold || surface.hold->held_by_prior == 0) continue;
    lines.push_back(std::to_string(surface.hold->held_by_prior) + " of " +
                    std::to_string(surface.hold->nodes) + " nodes of surface " +
                    std::to_string(surface.id) + " (" + surface.label +
                    ") are held by the prior alone");
  }
  return lines;
}

Json ToJson(const RunSummary& summary) {
  Json surfaces = Json::array();
  for (const auto& item : summary.surfaces) surfaces.push_back(ToJson(item));
  return {{"complete", summary.complete},
          {"status", summary.status},
          {"error", summary.error},
          {"resumed_at", summary.resumed_at},
          {"skipped_frames", summary.skipped_frames},
          {"preset", summary.preset},
          {"loops", ToJson(summary.loops)},
          {"frames", summary.frames},
          {"verdict", VerdictLine(summary)},
          {"lost_frames", summary.lost_frames},
          {"occluded_frames", summary.occluded_frames},
          {"refound_frames", summary.refound_frames},
          {"seconds_per_frame", SecondsPerFrame(summary)},
          {"seconds_writing", summary.seconds_writing},
          {"seconds_refining", summary.seconds_refining},
          {"seconds_coloring", summary.seconds_coloring},
          {"seconds_per_frame_all_passes", summary.all_seconds_per_frame},
          {"cpu_seconds_per_frame", summary.cpu_seconds_per_frame},
          {"peak_memory_bytes", summary.peak_memory_bytes},
          {"surfaces", surfaces},
          {"versions", Json(summary.versions)}};
}

void SummaryBuilder::Add(const FrameReport& report) {
  if (AnyIs(TrackState::kLost, report)) ++lost_frames_;
  if (AnyIs(TrackState::kOccluded, report)) ++occluded_frames_;
  seconds_.push_back(report.total_seconds);
  for (std::size_t i = 0; i < kFrameParts.size(); ++i) {
    part_sums_[i] += report.*kFrameParts[i].seconds;
  }
  bool any_refound = false;
  for (const SurfaceReport& surface : report.surfaces) {
    any_refound = AddSurface(report.frame, surface) || any_refound;
  }
  if (any_refound) ++refound_frames_;
}

bool SummaryBuilder::AddSurface(int frame, const SurfaceReport& report) {
  const auto [found, is_new] = surfaces_.try_emplace(report.id);
  SurfaceSummary& surface = found->second;
  if (is_new) surface.first_frame = frame;
  surface.id = report.id;
  surface.label = report.label;
  surface.kind = report.kind;
  const bool shown = report.state == TrackState::kTracked;
  const bool lost = report.state == TrackState::kLost;
  const bool occluded = report.state == TrackState::kOccluded;
  if (shown) ++surface.frames;
  if (lost) surface.lost.push_back(frame);
  if (occluded) surface.occluded.push_back(frame);
  const bool refound =
      shown && !is_new && last_states_.at(report.id) != TrackState::kTracked;
  last_states_[report.id] = report.state;
  if (refound) surface.refound.push_back(frame);
  if ((lost || occluded) && surface.away_since < 0) surface.away_since = frame;
  if (shown) surface.away_since = -1;
  if (report.event == "reanchored") surface.reanchored.push_back(frame);
  if (report.event == "relocalized") surface.relocalized.push_back(frame);
  if (report.nodes > 0) {
    surface.nodes = report.nodes;
    surface.node_spacing = report.node_spacing;
  }
  if (report.hold) surface.hold = report.hold;
  if (report.vertices > 0) surface.vertices = report.vertices;
  return refound;
}

void SummaryBuilder::SetWritten(int id, const WrittenSurface& written) {
  const auto found = surfaces_.find(id);
  if (found == surfaces_.end()) return;
  found->second.nodes = written.nodes;
  found->second.vertices = written.vertices;
  if (written.stretch.area > 0) {
    found->second.stretched = written.stretch.Share();
  }
}

RunSummary SummaryBuilder::Build() const {
  RunSummary summary;
  summary.frames = static_cast<int>(seconds_.size());
  summary.lost_frames = lost_frames_;
  summary.occluded_frames = occluded_frames_;
  summary.refound_frames = refound_frames_;
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

}  // namespace splitfusion
