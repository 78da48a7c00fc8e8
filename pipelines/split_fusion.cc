#include "splitfusion/pipelines/split_fusion.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/tracking/point_tracks.h"
#include "splitfusion/lib/tracking/translation_search.h"
#include "splitfusion/pipelines/frame_tracker.h"
#include "splitfusion/pipelines/objects_in_view.h"
#include "splitfusion/pipelines/surface_context.h"

namespace splitfusion {

SplitFusion::SplitFusion(const PinholeCamera& camera,
                         const PipelineOptions& options,
                         const LabelTable& labels,
                         std::shared_ptr<Segmenter> segmenter,
                         const Registries& registries)
    : camera_(camera),
      options_(options),
      segmenter_(std::move(segmenter)),
      splitter_(camera, labels, options.split),
      tracker_(std::make_unique<FrameTracker>(options, registries)),
      standing_(options),
      camera_misfit_(options.unusual_misfit) {
  options_.Check();
  camera_.Check();
}

SplitFusion::~SplitFusion() = default;

const SurfaceEnergies& SplitFusion::energies() const {
  return tracker_->energies();
}

PreparedFrame SplitFusion::PrepareUnsplit(const Frame& frame) const {
  PreparedFrame prepared =
      PrepareFrame(camera_, frame, options_.point_map, nullptr, color_camera_);
  const auto now = std::lower_bound(
      trajectory_.begin(), trajectory_.end(), frame.timestamp,
      [](const TimedPose& pose, double time) { return pose.timestamp < time; });
  if (now == trajectory_.end() || now == trajectory_.begin()) return prepared;
  const TimedPose& before = *std::prev(now);
  Unroll(now->world_from_camera.inverse() * before.world_from_camera,
         frame.timestamp - before.timestamp, &prepared);
  return prepared;
}

FrameReport SplitFusion::ProcessFrame(PreparedFrame prepared) {
  const Stopwatch stopwatch;
  const PreparedFrame rolled = prepared;
  const Rigid3d camera_motion = CameraMotion(prepared.frame.world_from_camera);
  // How a camera moves that is lost is not known.
  if (background_state_ == TrackState::kTracked) {
    Unroll(camera_motion, SecondsSince(prepared.frame), &prepared);
  }
  const Frame& frame = prepared.frame;
  FrameReport report;
  report.frame = frame.index;
  report.timestamp = frame.timestamp;
  report.stem = frame.stem;
  report.read_seconds = prepared.read_seconds;
  report.segment_seconds = prepared.segment_seconds;
  live_ = std::move(prepared.live);
  frame_ = {frame.index, frame.timestamp, &prepared.detections, &trajectory_};
  PredictMotions(camera_motion);
  Split(prepared, &report);
  const Stopwatch beginning;
  tracker_->Begin(surfaces_, live_);
  report.associate_seconds += beginning.Seconds();
  if (!surfaces_.empty()) {
    TrackCamera(rolled, &report);
    TrackObjects(&report);
    Fuse(&report);
    ReanchorLostSurfaces(&report);
  }
  AddNewSurfaces(frame, &report);
  Record(frame, &report);
  KeepSights(frame.world_from_camera.has_value(), report);
  tracker_->Keep(live_);
  report.total_seconds =
      report.read_seconds + report.segment_seconds + stopwatch.Seconds();
  return report;
}

/// That of points that stand still, since the frame before: as it is given, or
/// as the camera moved last.
Rigid3d SplitFusion::CameraMotion(const std::optional<Rigid3d>& given) const {
  if (surfaces_.empty()) return Rigid3d::Identity();
  return given ? (world_from_given_ * *given).inverse() * WorldFromCamera()
               : predictors_.at(0).velocity();
}

/// `seconds`: in which the camera moved so.
void SplitFusion::Unroll(const Rigid3d& camera_motion, double seconds,
                         PreparedFrame* prepared) const {
  if (rolling_shutter_ == 0 || !(seconds > 0)) return;
  // Of longer breaks it is not known how it moved.
  const double share = std::min(rolling_shutter_ / seconds, 1.0);
  UnrollFrame(camera_motion, share, options_.point_map, prepared);
}

/// Seconds since the frame before; 0 if there is none.
double SplitFusion::SecondsSince(const Frame& frame) const {
  return trajectory_.empty() ? 0
                             : frame.timestamp - trajectory_.back().timestamp;
}

/// The camera seldom moves as it did last: once more with the motion that was
/// found.
void SplitFusion::UnrollAsTracked(const PreparedFrame& rolled,
                                  const std::vector<ModelSample>& samples,
                                  FrameReport* report) {
  if (rolling_shutter_ == 0 || camera_was_lost_ ||
      background_state_ != TrackState::kTracked) {
    return;
  }
  PreparedFrame again = rolled;
  Unroll(WorldFromCamera().inverse() * trajectory_.back().world_from_camera,
         SecondsSince(rolled.frame), &again);
  again.live.labels = live_.labels;
  again.live.uncertain = live_.uncertain;
  live_ = std::move(again.live);
  TrackBackground(samples, Rigid3d::Identity(), /*goes_on=*/true, report);
}

void SplitFusion::PredictMotions(const Rigid3d& camera_motion) {
  if (surfaces_.empty()) return;
  camera_was_lost_ = background_state_ != TrackState::kTracked;
  const Rigid3d world_from_camera = WorldFromCamera();
  const Rigid3d camera_from_world = camera_motion * world_from_camera.inverse();
  for (const auto& [id, surface] : surfaces_) {
    const Rigid3d motion = id == 0 ? camera_motion
                                   : camera_from_world *
                                         predictors_.at(id).velocity() *
                                         world_from_camera;
    ApplyRigidMotion(motion, surface->mutable_graph());
  }
}

void SplitFusion::Split(const PreparedFrame& prepared, FrameReport* report) {
  Stopwatch stopwatch;
  rendering_ =
      RenderMeshes(surfaces_, camera_.Subsampled(options_.render_stride));
  background_map_ = RenderBackground(surfaces_, camera_, options_.render_stride,
                                     options_.ray_cast);
  report->render_seconds += stopwatch.Restart();
  if (segmenter() == nullptr) return;
  SurfacePrediction prediction =
      ToPrediction(rendering_, background_map_, camera_);
  prediction.world_from_camera = WorldFromCamera();
  SplitResult split = splitter_.Split(prepared.frame, live_.map,
                                      prepared.detections, prediction);
  live_.labels = split.labels;
  if (!split.uncertain.empty()) live_.uncertain = split.uncertain;
  report->decisions = std::move(split.decisions);
  detected_standing_ = std::move(split.standing);
  const bool gone = EndGoneTracks();
  FollowTracks();
  report->split_seconds = stopwatch.Restart();
  if (gone || !AllDrawn(surfaces_, rendering_)) {  // Or revived.
    rendering_ =
        RenderMeshes(surfaces_, camera_.Subsampled(options_.render_stride));
    report->render_seconds += stopwatch.Restart();
  }
}

FrameScene SplitFusion::Scene() const {
  return {frame_,
          live_,
          surfaces_,
          rendering_,
          background_map_,
          WorldFromCamera().inverse() * trajectory_.back().world_from_camera};
}

bool SplitFusion::TrackSurface(const std::vector<ModelSample>& samples,
                               const Rigid3d& still, bool goes_on,
                               Surface* surface, SurfaceReport* report) {
  return tracker_->Track(samples, still, goes_on, Scene(), surface, report);
}

std::vector<ModelSample> SplitFusion::BackgroundInView(
    FrameReport* report) const {
  const Stopwatch stopwatch;
  const Surface& background = *surfaces_.at(0);
  std::vector<ModelSample> samples =
      background.is_ray_cast()
          ? BackgroundSamples(background_map_,
                              MeanRigidMotion(background.graph()),
                              options_.render_stride)
          : VisibleSamples(rendering_, background, options_.render_stride);
  report->render_seconds += stopwatch.Seconds();
  return samples;
}

void SplitFusion::TrackCamera(const PreparedFrame& rolled,
                              FrameReport* report) {
  if (rolled.frame.world_from_camera) {
    background_state_ = TrackState::kTracked;
    report->surfaces.emplace_back().id = 0;
    return;
  }
  const Rigid3d predicted = MeanRigidMotion(surfaces_.at(0)->graph());
  std::vector<ModelSample> samples = BackgroundInView(report);
  TrackBackground(samples, predictors_.at(0).velocity().inverse(),
                  /*goes_on=*/true, report);
  if (!IsCameraFound(*report) && surfaces_.at(0)->graph().rigid()) {
    FindCamera(predicted, &samples, report);
  }
  UnrollAsTracked(rolled, samples, report);
  if (SetMoversApart(samples, report)) {
    TrackBackground(samples, Rigid3d::Identity(), /*goes_on=*/true, report);
  }
  if (background_state_ == TrackState::kTracked) {
    tracker_->KeepUnknowns(*surfaces_.at(0), report->surfaces.front());
  }
}

void SplitFusion::TrackBackground(const std::vector<ModelSample>& samples,
                                  const Rigid3d& still, bool goes_on,
                                  FrameReport* report) {
  Surface& background = *surfaces_.at(0);
  SurfaceReport surface;
  surface.id = 0;
  const Rigid3d before = MeanRigidMotion(background.graph());
  background_state_ =
      TrackSurface(samples, still, goes_on, &background, &surface)
          ? TrackState::kTracked
          : TrackState::kLost;
  MoveObjects(MeanRigidMotion(background.graph()) * before.inverse());
  report->surfaces.assign(1, std::move(surface));
}

void SplitFusion::MoveObjects(const Rigid3d& camera_motion) {
  for (const auto& [id, object] : surfaces_) {
    // Where an object was seen is known but in the frame of a lost camera.
    if (id == 0 || (camera_was_lost_ && StateOf(id) == TrackState::kTracked)) {
      continue;
    }
    ApplyRigidMotion(camera_motion, object->mutable_graph());
  }
}

bool SplitFusion::SetMoversApart(const std::vector<ModelSample>& samples,
                                 FrameReport* report) {
  Surface& background = *surfaces_.at(0);
  if (options_.own_motion_gain == 0 || !background.is_ray_cast() ||
      background_state_ != TrackState::kTracked) {
    return false;
  }
  const Stopwatch stopwatch;
  const SurfaceContext known(frame_, background, background, /*goes_on=*/true);
  const std::vector<StandingObjects::Moving> moving =
      standing_.Watch(std::move(detected_standing_), samples, live_,
                      background.graph(), known.view());
  for (const auto& [object, points] : moving) {
    background.Forget(points);
    live_.uncertain.setTo(255, object.mask & (live_.labels == 0));
    splitter_.BelieveMoving(object);
    report->decisions.push_back(
        {"moves", 0, object.class_name, object.score, 0});
  }
  report->associate_seconds += stopwatch.Seconds();
  return !moving.empty();
}

void SplitFusion::TrackObjects(FrameReport* report) {
  std::vector<SurfaceReport> objects =
      LookAtObjects(surfaces_, rendering_, live_, options_.render_stride);
  std::vector<char> found(objects.size(), false);
  tbb::parallel_for(std::size_t{0}, objects.size(), [&](std::size_t i) {
    const Surface& surface = *surfaces_.at(objects[i].id);
    if (!IsEnoughInView(objects[i], options_) ||
        StateOf(surface.id()) != TrackState::kTracked) {
      return;
    }
    found[i] = TrackObject(/*goes_on=*/true, surfaces_.at(objects[i].id).get(),
                           &objects[i]);
  });
  // One after the other: a surface found elsewhere changes the rendering.
  for (std::size_t i = 0; i < objects.size(); ++i) {
    SurfaceReport& object = objects[i];
    Track* track = splitter_.mutable_track(object.id);
    if (!IsEnoughInView(object, options_)) {
      object.reason = std::to_string(static_cast<int>(100 * object.exposure)) +
                      " % of the model in view";
      track->Apply(TrackEvent::kLittleInView);
    } else if (found[i] ||
               TrackWhereSeen(surfaces_.at(object.id).get(), &object)) {
      track->Apply(TrackEvent::kFits);
      tracker_->KeepUnknowns(*surfaces_.at(object.id), object);
    } else {
      // Too little of it may be in view to know where it is.
      track->Apply(InPlainView(object) ? TrackEvent::kMisfits
                                       : TrackEvent::kLittleInView);
    }
    report->surfaces.push_back(std::move(object));
  }
}

bool SplitFusion::EndGoneTracks() {
  bool any = false;
  for (const SurfaceReport& object :
       LookAtObjects(surfaces_, rendering_, live_, options_.render_stride)) {
    Track* track = splitter_.mutable_track(object.id);
    // So few do not make a surface, by far.
    if (!track->followed() || object.exposure < options_.min_exposure ||
        object.pixels >= options_.split.min_pixels / 4) {
      continue;
    }
    track->Apply(TrackEvent::kGone);
    any = true;
  }
  return any;
}

TrackState SplitFusion::StateOf(int id) const {
  return id == 0 ? background_state_ : splitter_.tracks().at(id).state;
}

bool SplitFusion::TrackObject(bool goes_on, Surface* surface,
                              SurfaceReport* report) {
  Stopwatch stopwatch;
  const std::vector<ModelSample> samples =
      VisibleSamples(rendering_, *surface, options_.render_stride);
  report->render_seconds += stopwatch.Restart();
  const Rigid3d world_from_camera = WorldFromCamera();
  const Rigid3d still = world_from_camera.inverse() *
                        predictors_.at(surface->id()).velocity().inverse() *
                        world_from_camera;
  return TrackSurface(samples, still, goes_on, surface, report);
}

void SplitFusion::Fuse(FrameReport* report) {
  std::vector<SurfaceReport>& reports = report->surfaces;
  tbb::parallel_for(std::size_t{0}, reports.size(), [&](std::size_t i) {
    if (StateOf(reports[i].id) != TrackState::kTracked) return;
    Surface& surface = *surfaces_.at(reports[i].id);
    Stopwatch stopwatch;
    // What touched moves apart with the motions, and fusion may join it again.
    reports[i].torn_triangles = surface.Tear(live_);
    reports[i].refuted_nodes = surface.Fuse(live_);
    reports[i].fuse_seconds = stopwatch.Restart();
    if (!surface.is_ray_cast()) surface.UpdateMesh();
    reports[i].torn_triangles += surface.Tear(live_);
    reports[i].mesh_seconds = stopwatch.Restart();
  });
}

void SplitFusion::FollowTracks() {
  for (const auto& [id, track] : splitter_.tracks()) {
    const auto found = surfaces_.find(id);
    if (found == surfaces_.end()) continue;
    if (track.merged_into > 0) {
      surfaces_.erase(found);
      predictors_.erase(id);
      tracker_->ForgetGone(id);
      continue;
    }
    found->second->set_inactive(!track.followed());
    found->second->set_label(track.class_name);
  }
}

void SplitFusion::AddNewSurfaces(const Frame& frame, FrameReport* report) {
  const auto add = [&](int id, const std::string& label, SurfaceKind kind) {
    auto surface = std::make_unique<Surface>(id, label, kind, frame.index,
                                             OptionsOf(id), options_.graph);
    if (!surface->Initialize(live_)) return;
    surfaces_[id] = std::move(surface);
    if (id != 0) {
      splitter_.mutable_track(id)->Apply(TrackEvent::kFits);
      Surface& background = *surfaces_.at(0);
      // What was fused of it before it was told apart.
      if (kind == SurfaceKind::kRigid && background.is_ray_cast()) {
        background.ForgetOther(live_, id);
      }
    }
    SurfaceReport born;
    born.id = id;
    born.event = "born";
    report->surfaces.push_back(std::move(born));
  };
  if (surfaces_.empty()) {
    add(0, "background",
        options_.deform_background ? SurfaceKind::kNonRigid
                                   : SurfaceKind::kRigid);
    // The canonical frame of the background is the world.
    if (surfaces_.empty()) return;
    if (frame.world_from_camera) {
      world_from_given_ = frame.world_from_camera->inverse();
    }
  }
  if (!options_.model_objects) return;
  const std::map<int, int> pixels = PixelsOfSurfaces(live_);
  const double min_pixels =
      options_.min_birth_area * camera_.width * camera_.height;
  for (const auto& [id, track] : splitter_.tracks()) {
    const auto seen = pixels.find(id);
    if (surfaces_.count(id) != 0 || seen == pixels.end() ||
        seen->second < min_pixels) {
      continue;
    }
    add(id, track.class_name,
        options_.deform_objects ? track.kind : SurfaceKind::kRigid);
  }
}

void SplitFusion::Record(const Frame& frame, FrameReport* report) {
  const std::map<int, int> pixels = PixelsOfSurfaces(live_);
  const Rigid3d world_from_camera = WorldFromCamera();
  trajectory_.push_back({frame.timestamp, world_from_camera});
  for (SurfaceReport& surface_report : report->surfaces) {
    const int id = surface_report.id;
    Surface& surface = *surfaces_.at(id);
    const auto seen = pixels.find(id);
    surface_report.pixels = seen == pixels.end() ? 0 : seen->second;
    surface_report.label = surface.label();
    surface_report.kind = surface.kind();
    surface_report.nodes = surface.graph().size();
    surface_report.node_spacing = surface.graph().node_spacing;
    surface_report.vertices = static_cast<int>(surface.mesh().vertices.size());
    surface_report.state = StateOf(id);
    const bool tracked = surface_report.state == TrackState::kTracked;
    surface.RecordMotions(
        frame.index, tracked,
        tracked ? surface.SeenNodes(live_) : std::vector<char>());
    const Rigid3d motion = MeanRigidMotion(surface.graph());
    const Rigid3d placed = id == 0 ? motion : world_from_camera * motion;
    // Of a lost camera nobody knows where in the world its objects are.
    predictors_[id].Record(placed, Center(surface.graph()),
                           background_state_ == TrackState::kTracked
                               ? StateOf(id)
                               : TrackState::kLost);
    report->render_seconds += surface_report.render_seconds;
    report->associate_seconds += surface_report.associate_seconds;
    report->solve_seconds += surface_report.solve_seconds;
    report->fuse_seconds += surface_report.fuse_seconds;
    report->mesh_seconds += surface_report.mesh_seconds;
  }
}

std::map<int, Rigid3d> SplitFusion::PosesByFrame() const {
  std::map<int, Rigid3d> poses;
  const auto background = surfaces_.find(0);
  if (background == surfaces_.end()) return poses;
  // It has an entry for every frame since its birth, as the trajectory has.
  const MotionLog& frames = background->second->history();
  const std::size_t before = trajectory_.size() - frames.size();
  for (int i = 0; i < frames.size(); ++i) {
    poses[frames.frame(i)] = trajectory_[before + i].world_from_camera;
  }
  return poses;
}

void SplitFusion::Finish() {
  for (const auto& [id, surface] : surfaces_) surface->FinishMesh();
}

Rigid3d SplitFusion::WorldFromCamera() const {
  const auto background = surfaces_.find(0);
  if (background == surfaces_.end()) return Rigid3d::Identity();
  return MeanRigidMotion(background->second->graph()).inverse();
}

}  // namespace splitfusion
