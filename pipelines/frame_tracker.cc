#include "splitfusion/pipelines/frame_tracker.h"

#include <cstdint>
#include <set>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/pipelines/surface_context.h"

namespace splitfusion {

FrameTracker::FrameTracker(const PipelineOptions& options,
                           const Registries& registries)
    : follows_points_(options.point_tracks.spacing > 0),
      starts_parts_(options.tracker.part_start.parts.count > 0),
      non_rigid_distance_(options.tracker.non_rigid_distance),
      point_tracks_(options.point_tracks),
      matcher_(options.match),
      key_frames_(options.key_frames),
      match_ratio_(options.match.ratio),
      tracker_(options.tracker, options.solver,
               SurfaceEnergies::Parse(options.terms, registries.terms),
               registries.associations, registries.solvers) {}

void FrameTracker::Begin(const SurfaceMap& surfaces, const LiveView& live) {
  if (starts_parts_) matcher_.Begin(live);
  std::set<int> followed;
  for (const auto& [id, surface] : surfaces) {
    // Surfaces are tracked at the same time: none is to add itself.
    term_states_[id];
    if (Follows(*surface)) followed.insert(id);
  }
  if (follows_points_ && !surfaces.empty()) {
    point_tracks_.Follow(live, followed);
  }
}

bool FrameTracker::Track(const std::vector<ModelSample>& samples,
                         const Rigid3d& still, bool goes_on,
                         const FrameScene& scene, Surface* surface,
                         SurfaceReport* report) {
  Stopwatch stopwatch;
  const int id = surface->id();
  DeformationGraph* graph = surface->mutable_graph();
  std::vector<TrackedPoint> points;
  if (Follows(*surface)) {
    points =
        point_tracks_.Find(id, samples, surface->skinning_index(),
                           WarpField(*graph), scene.live, non_rigid_distance_);
  }
  report->track_points = static_cast<int>(points.size());
  SurfaceContext known(scene.frame, *surface, *scene.surfaces.at(0), goes_on);
  known.SetRendered(scene.rendering, scene.background);
  TermStates* states = &term_states_.at(id);
  known.PrepareTerms(energies(), scene.live, points, term_states_.at(0),
                     states);
  const std::vector<PointMotion> motions =
      goes_on ? MatchPoints(*surface, scene) : std::vector<PointMotion>();
  report->associate_seconds += stopwatch.Restart();
  const bool tracked = tracker_.Track(samples, points, scene.live,
                                      static_cast<std::uint16_t>(id), still,
                                      graph, report, known.view(), motions);
  stopwatch.Restart();
  if (tracked && Follows(*surface)) {
    point_tracks_.Begin(id, samples, WarpField(*graph), scene.live);
  }
  report->associate_seconds += stopwatch.Seconds();
  return tracked;
}

void FrameTracker::KeepUnknowns(const Surface& surface,
                                const SurfaceReport& report) {
  if (report.rounds.empty()) return;
  term_states_.at(surface.id())
      .KeepUnknowns(energies().Of(surface.label()),
                    FinalUnknowns(report.rounds.back().solver));
}

std::vector<PointMotion> FrameTracker::MatchPoints(
    const Surface& surface, const FrameScene& scene) const {
  std::vector<PointMotion> motions;
  if (!starts_parts_ || surface.id() == 0 || surface.graph().rigid()) {
    return motions;
  }
  motions = matcher_.Match(surface.id(), scene.live,
                           point_tracks_.FlowOf(surface.id()));
  const Rigid3f still = scene.camera_from_previous_camera.cast<float>();
  for (PointMotion& motion : motions) motion.from = still * motion.from;
  return motions;
}

void FrameTracker::Keep(const LiveView& live) {
  if (starts_parts_) matcher_.Keep(live);
}

void FrameTracker::KeepSight(const Surface& surface, const LiveView& live) {
  sights_.Keep(surface.id(), live, MeanRigidMotion(surface.graph()));
}

std::optional<Rigid3d> FrameTracker::MotionSinceSight(
    const Surface& surface, const LiveView& live) const {
  return sights_.FindMotion(surface.id(), live,
                            MeanRigidMotion(surface.graph()), match_ratio_);
}

void FrameTracker::Forget(int id) {
  point_tracks_.End(id);
  ForgetGone(id);
}

void FrameTracker::ForgetGone(int id) {
  term_states_.erase(id);
  sights_.Forget(id);
}

}  // namespace splitfusion
