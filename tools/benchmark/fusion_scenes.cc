#include "fusion_scenes.h"

#include <cmath>
#include <limits>
#include <utility>

#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/model/observe_surface.h"

namespace splitfusion {
namespace {

SyntheticOptions RoomOptions() {
  SyntheticOptions options;
  options.scene = SyntheticSceneKind::kRoom;
  return options;
}

SyntheticOptions StandingPersonOptions() {
  SyntheticOptions options;
  options.scene = SyntheticSceneKind::kPerson;
  options.camera_motion = 0;
  options.subject_speed = 0;
  options.exact_masks = true;
  return options;
}

SyntheticOptions WalkingPersonOptions() {
  SyntheticOptions options;
  options.exact_masks = true;
  return options;
}

/// 5 mm voxels, with a truncation in voxels.
TsdfOptions FineVoxels(int truncation, bool has_color) {
  TsdfOptions options;
  options.voxel_size = 0.005;
  options.truncation = truncation * options.voxel_size;
  options.has_color = has_color;
  return options;
}

/// What a frame of a scene shows, labelled exactly.
LiveView LabelledView(const SyntheticScene& scene, int frame) {
  const SyntheticFrame rendered = scene.Render(frame);
  LiveView live =
      MakeLiveView(scene.camera(), rendered.frame.depth, rendered.frame.color);
  rendered.labels.convertTo(live.labels, CV_16U);
  return live;
}

/// Every point is where it belongs: the person stands still.
void SetPlaces(const LiveView& live, int surface, DepthObservation* observed) {
  const float nowhere = std::numeric_limits<float>::quiet_NaN();
  observed->places.create(live.depth.size());
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols; ++u) {
      const bool on_it = live.labels(v, u) == surface && live.depth(v, u) > 0;
      observed->places(v, u) =
          on_it ? live.map.points(v, u) : cv::Vec3f(nowhere, nowhere, nowhere);
    }
  }
  observed->place_tolerance = 0.05;
}

}  // namespace

std::vector<MaskedFrame> FilmScene(const SyntheticScene& scene, int count) {
  std::vector<MaskedFrame> film;
  for (int i = 0; i < count; ++i) {
    const SyntheticFrame rendered = scene.Render(i);
    film.push_back({rendered.frame, scene.Detections(rendered)});
  }
  return film;
}

RoomModel::RoomModel(const TsdfOptions& options) : volume(options) {
  constexpr int kFrames = 4, kStep = 5;
  const SyntheticScene scene(RoomOptions());
  for (int i = 0; i < kFrames; ++i) {
    observation = ObserveSurface(LabelledView(scene, i * kStep), 0);
    camera_from_canonical = scene.WorldFromCamera(i * kStep).inverse();
    AllocateBand(observation, camera_from_canonical, &volume);
    if (i + 1 == kFrames) break;
    IntegrateRigid(observation, camera_from_canonical, &volume);
  }
}

RoomModel& FineRoom(bool has_color) {
  static RoomModel plain(FineVoxels(/*truncation=*/4, /*has_color=*/false));
  if (!has_color) return plain;
  static RoomModel colored(FineVoxels(/*truncation=*/4, /*has_color=*/true));
  return colored;
}

PersonModel& PersonModel::Shared() {
  static PersonModel person;
  return person;
}

const TrackedScene& TrackedScene::Shared() {
  static const TrackedScene tracked;
  return tracked;
}

PersonModel::PersonModel()
    : scene(StandingPersonOptions()),
      volume(FineVoxels(/*truncation=*/6, /*has_color=*/true)) {
  constexpr int kFrames = 3, kSurface = 1;
  for (int i = 0; i < kFrames; ++i) {
    const LiveView live = LabelledView(scene, i);
    DepthObservation observation = ObserveSurface(live, kSurface);
    SetPlaces(live, kSurface, &observation);
    observations.push_back(std::move(observation));
  }
  AllocateBand(observations[0], Rigid3d::Identity(), &volume);
  IntegrateRigid(observations[0], Rigid3d::Identity(), &volume);
  GraphOptions options;
  graph.node_spacing = 0.04;
  GrowGraph(ExtractMesh(volume, 1e-3), options, &graph, nullptr);
  index = std::make_unique<SkinningIndex>(graph, options.neighbors_per_point);
  AllocateAround(graph.positions,
                 graph.node_spacing + volume.options().truncation, &volume);
  Integrate(0);
}

void PersonModel::Integrate(int observation) {
  integrator.Integrate(observations[observation], *index, WarpField(graph),
                       reach, &volume);
}

TrackedScene::TrackedScene()
    : scene(WalkingPersonOptions()),
      film(FilmScene(scene, /*count=*/8)),
      fusion(scene.camera(), PipelineOptions(), LabelTable(),
             std::make_shared<GivenMasks>(film)),
      live(LabelledView(scene, film.back().frame.index)) {
  for (const MaskedFrame& frame : film) fusion.ProcessFrame(frame.frame);
  fusion.labels().copyTo(live.labels);
}

}  // namespace splitfusion
