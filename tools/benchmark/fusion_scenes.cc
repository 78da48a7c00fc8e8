#include "fusion_scenes.h"

#include <cmath>
#include <limits>
#include <utility>

#include "splitfusion/lib/deformation/graph_growth.h"

namespace splitfusion {
namespace {

/// Gives the exact masks of a scene's frames.
class SceneSegmenter : public Segmenter {
 public:
  explicit SceneSegmenter(const SyntheticScene& scene) : scene_(scene) {}

  std::vector<InstanceMask> Segment(const Frame& frame) override {
    return scene_.Detections(scene_.Render(frame.index));
  }

 private:
  const SyntheticScene& scene_;
};

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
  observed->place_tolerance = 0.08;
}

}  // namespace

TsdfOptions FineVoxels(int truncation, bool has_color) {
  TsdfOptions options;
  options.voxel_size = 0.005;
  options.truncation = truncation * options.voxel_size;
  options.has_color = has_color;
  return options;
}

LiveView MakeLiveView(const SyntheticScene& scene, int frame) {
  const SyntheticFrame rendered = scene.Render(frame);
  LiveView live =
      MakeLiveView(scene.camera(), rendered.frame.depth, rendered.frame.color);
  rendered.labels.convertTo(live.labels, CV_16U);
  return live;
}

DepthObservation ObserveSurface(const LiveView& live, int surface) {
  DepthObservation observation;
  observation.camera = live.camera;
  observation.depth = live.depth;
  observation.weight = live.confidence;
  observation.color = live.color;
  observation.role.create(live.depth.size());
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols; ++u) {
      const PixelRole role = live.edges(v, u) != 0          ? PixelRole::kNone
                             : live.labels(v, u) == surface ? PixelRole::kWrite
                                                            : PixelRole::kCarve;
      observation.role(v, u) = static_cast<std::uint8_t>(role);
    }
  }
  return observation;
}

RoomModel::RoomModel(const TsdfOptions& options) : volume(options) {
  constexpr int kFrames = 4, kStep = 5;
  const SyntheticScene scene(RoomOptions());
  for (int i = 0; i < kFrames; ++i) {
    observation = ObserveSurface(MakeLiveView(scene, i * kStep), 0);
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
    const LiveView live = MakeLiveView(scene, i);
    DepthObservation observation = ObserveSurface(live, kSurface);
    SetPlaces(live, kSurface, &observation);
    observations.push_back(std::move(observation));
  }
  AllocateBand(observations[0], Rigid3d::Identity(), &volume);
  IntegrateRigid(observations[0], Rigid3d::Identity(), &volume);
  mesh = ExtractMesh(volume, 1e-3);
  GraphOptions options;
  graph.node_spacing = 0.04;
  GrowGraph(mesh, options, &graph, nullptr);
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
      fusion(scene.camera(), PipelineOptions(), LabelTable(),
             std::make_shared<SceneSegmenter>(scene)) {
  constexpr int kFrames = 8;
  for (int i = 0; i < kFrames; ++i) {
    fusion.ProcessFrame(scene.Render(i).frame);
  }
  live = MakeLiveView(scene, kFrames - 1);
  fusion.labels().copyTo(live.labels);
}

}  // namespace splitfusion
