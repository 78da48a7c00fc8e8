#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/tracking/translation_search.h"
#include "splitfusion/pipelines/frame_tracker.h"
#include "splitfusion/pipelines/split_fusion.h"

/// What SplitFusion does where the predicted place of a surface, or of the
/// camera, is not where it is.

namespace splitfusion {

bool SplitFusion::FitsAsUsual(const FrameReport& report) const {
  return background_state_ == TrackState::kTracked &&
         report.surfaces.front().misfit <= camera_misfit_.Highest();
}

bool SplitFusion::IsCameraFound(const FrameReport& report) const {
  return FitsAsUsual(report) && report.surfaces.front().settled;
}

void SplitFusion::FindCamera(const Rigid3d& predicted,
                             std::vector<ModelSample>* samples,
                             FrameReport* report) {
  const Stopwatch stopwatch;
  const std::vector<Rigid3d> places = tracker_->CameraPlaces(live_);
  const double seconds = stopwatch.Seconds();
  CameraFit best = FitOfCamera(*report);
  const bool unusual = !FitsAsUsual(*report);
  bool known = false, elsewhere = false;
  for (const Rigid3d& place : places) {
    MoveCamera(place);
    FrameReport attempt;
    const std::vector<ModelSample> in_view = BackgroundInView(&attempt);
    TrackBackground(in_view, Rigid3d::Identity(), /*goes_on=*/false, &attempt);
    CameraFit fit = FitOfCamera(attempt);
    known |= fit.state == TrackState::kTracked;
    if (fit.misfit >= best.misfit) continue;
    best = std::move(fit);
    *samples = in_view;
    elsewhere = true;
    if (IsCameraFound(attempt)) break;
  }
  if (!known && unusual && best.state == TrackState::kTracked) {
    best.state = TrackState::kLost;
    best.camera_from_world = predicted;
    best.report.reason = "misfit " + std::to_string(best.misfit) +
                         ", and no landmarks are known; expected below " +
                         std::to_string(camera_misfit_.Highest());
  }
  MoveCamera(best.camera_from_world);
  background_state_ = best.state;
  report->surfaces.front() = std::move(best.report);
  report->surfaces.front().associate_seconds += seconds;
  if (!elsewhere) return;
  report->surfaces.front().event = "relocalized";
  rendering_ =
      RenderMeshes(surfaces_, camera_.Subsampled(options_.render_stride));
}

void SplitFusion::MoveCamera(const Rigid3d& camera_from_world) {
  Surface& background = *surfaces_.at(0);
  const Rigid3d motion =
      camera_from_world * MeanRigidMotion(background.graph()).inverse();
  if (motion.isApprox(Rigid3d::Identity(), 0)) return;
  ApplyRigidMotion(motion, background.mutable_graph());
  MoveObjects(motion);
  background_map_ = RenderBackground(surfaces_, camera_, options_.render_stride,
                                     options_.ray_cast);
}

SplitFusion::CameraFit SplitFusion::FitOfCamera(
    const FrameReport& report) const {
  CameraFit fit;
  fit.camera_from_world = MeanRigidMotion(surfaces_.at(0)->graph());
  fit.state = background_state_;
  fit.report = report.surfaces.front();
  if (fit.state == TrackState::kTracked) fit.misfit = fit.report.misfit;
  return fit;
}

std::vector<Rigid3d> SplitFusion::WaysToWhereSeen(const Surface& surface,
                                                  SurfaceReport* report) const {
  const Stopwatch stopwatch;
  std::vector<Rigid3d> ways;
  const auto add = [&](const std::optional<Rigid3d>& way) {
    if (way) ways.push_back(*way);
  };
  if (options_.last_sights) add(tracker_->MotionSinceSight(surface, live_));
  const double deviation = options_.split.assignment.PlaceDeviation(
      predictors_.at(surface.id()).frames_since() + 1);
  const PinholeCamera camera = camera_.Subsampled(options_.render_stride);
  const std::optional<Rigid3d> shift =
      FindTranslation(VisibleSamples(RenderAlone(surface, camera), surface,
                                     options_.render_stride),
                      WarpField(surface.graph()), live_,
                      static_cast<std::uint16_t>(surface.id()), deviation);
  add(shift);
  // Where it was predicted a tracked one has just failed.
  const bool failed = StateOf(surface.id()) == TrackState::kTracked;
  if (!shift && !failed) ways.push_back(Rigid3d::Identity());
  report->render_seconds += stopwatch.Seconds();
  return ways;
}

bool SplitFusion::TrackWhereSeen(Surface* surface, SurfaceReport* report) {
  const DeformationGraph before = surface->graph();
  const PointTracks tracks_before = tracker_->point_tracks();
  const std::vector<Rigid3d> ways = WaysToWhereSeen(*surface, report);
  const PinholeCamera camera = camera_.Subsampled(options_.render_stride);
  for (const Rigid3d& way : ways) {
    ApplyRigidMotion(way, surface->mutable_graph());
    rendering_ = RenderMeshes(surfaces_, camera);
    if (TrackObject(/*goes_on=*/false, surface, report) &&
        ExplainsItsPixels(report)) {
      return true;
    }
    *surface->mutable_graph() = before;
    tracker_->set_point_tracks(tracks_before);
  }
  if (!ways.empty()) rendering_ = RenderMeshes(surfaces_, camera);
  return false;
}

bool SplitFusion::ExplainsItsPixels(SurfaceReport* report) const {
  const TrackingRound& last = report->rounds.back();
  const int step = std::max(last.stride, options_.render_stride);
  int certain = 0;
  for (int v = 0; v < live_.depth.rows; v += step) {
    for (int u = 0; u < live_.depth.cols; u += step) {
      certain += IsCertain(live_, report->id, v, u);
    }
  }
  if (last.association.accepted >= options_.min_coverage * certain) return true;
  report->reason = "only " + std::to_string(last.association.accepted) +
                   " model points for " + std::to_string(certain) +
                   " live pixels at stride " + std::to_string(step);
  return false;
}

bool SplitFusion::InPlainView(const SurfaceReport& report) const {
  const double least =
      std::max(options_.min_birth_area * camera_.width * camera_.height,
               0.5 * splitter_.tracks().at(report.id).usual_pixels);
  return report.pixels >= least;
}

void SplitFusion::KeepSights(bool given, const FrameReport& report) {
  if (background_state_ == TrackState::kTracked && !report.surfaces.empty()) {
    const SurfaceReport& background = report.surfaces.front();
    if (!background.rounds.empty()) camera_misfit_.Add(background.misfit);
    if (surfaces_.at(0)->graph().rigid()) {
      if (options_.close_loops && !given) {
        const bool goes_on =
            !camera_was_lost_ && background.event != "relocalized";
        tracker_->KeepOnPath(*surfaces_.at(0), live_, report.frame, goes_on);
      }
      tracker_->KeepCamera(*surfaces_.at(0), live_);
    }
  }
  if (!options_.last_sights) return;
  for (const SurfaceReport& object : report.surfaces) {
    if (object.id != 0 && object.state == TrackState::kTracked &&
        InPlainView(object)) {
      tracker_->KeepSight(*surfaces_.at(object.id), live_);
    }
  }
}

void SplitFusion::ReanchorLostSurfaces(FrameReport* report) {
  for (SurfaceReport& object : report->surfaces) {
    if (object.id == 0) continue;
    Track& track = *splitter_.mutable_track(object.id);
    if (track.state == TrackState::kTracked) {
      const double share = track.usual_pixels > 0 ? 1.0 / kUsualFrames : 1;
      track.usual_pixels += share * (object.pixels - track.usual_pixels);
    }
    // Of a cost that is no number the model is not to blame.
    if (!object.rounds.empty() && !object.rounds.back().solver.usable) continue;
    Surface& surface = *surfaces_.at(object.id);
    // Joined models of one node each would share it in Eq. 3.
    if (track.state != TrackState::kLost ||
        track.lost_frames < options_.max_lost || surface.graph().rigid() ||
        !surface.Reanchor(live_)) {
      continue;
    }
    track.Apply(TrackEvent::kFits);
    object.event = "reanchored";
    tracker_->Forget(object.id);
    predictors_.erase(object.id);
  }
}

LoopClosure SplitFusion::CloseCameraLoops() const {
  const auto found = surfaces_.find(0);
  if (found == surfaces_.end() || !found->second->graph().rigid()) return {};
  std::map<int, Rigid3d> tracked = PosesByFrame();
  const MotionLog& frames = found->second->history();
  for (int i = 0; i < frames.size(); ++i) {
    if (!frames.tracked(i)) tracked.erase(frames.frame(i));
  }
  return CloseLoops(tracker_->CameraPath(camera_), tracked, camera_.noise,
                    options_.key_frames, options_.tracker.rigid_distance);
}

void SplitFusion::PlaceLostCamera() {
  const auto found = surfaces_.find(0);
  if (found == surfaces_.end() || !found->second->graph().rigid()) return;
  Surface& background = *found->second;
  const MotionLog& frames = background.history();
  const std::size_t before = trajectory_.size() - frames.size();
  // The known frame next to i in one direction; i if there is none.
  const auto known_beside = [&](int i, int step) {
    for (int k = i + step; k >= 0 && k < frames.size(); k += step) {
      if (frames.tracked(k)) return k;
    }
    return i;
  };
  const auto pose_of = [&](int i) { return trajectory_[before + i]; };
  for (int i = 0; i < frames.size(); ++i) {
    if (frames.tracked(i)) continue;
    const int from = known_beside(i, -1), to = known_beside(i, 1);
    TimedPose& pose = trajectory_[before + i];
    pose.world_from_camera =
        to == i ? pose_of(from).world_from_camera
                : PoseAmid({pose_of(known_beside(from, -1)), pose_of(from),
                            pose_of(to), pose_of(known_beside(to, 1))},
                           pose.timestamp);
    background.PlaceIn(i, pose.world_from_camera.inverse());
  }
}

}  // namespace splitfusion
