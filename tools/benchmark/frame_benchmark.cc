// The parts of a 640x480 frame that are not fusion or solving, and a frame of
// the whole method. The network runs if the environment variable
// SPLITFUSION_MODEL names an ONNX file (and SPLITFUSION_DECODER its decoder,
// else yolov8seg).

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "fusion_scenes.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/association/association.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/network_segmenter.h"
#include "splitfusion/lib/split/surface_splitter.h"
#include "splitfusion/lib/tsdf/mesh_extractor.h"

namespace splitfusion {
namespace {

/// Two frames are fused in turn, so that there is always something new.
void Remesh(benchmark::State& state) {
  constexpr double kMinWeight = 0.05;
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  MeshExtractor extractor;
  TriangleMesh mesh = extractor.Extract(person.volume, kMinWeight);
  int frame = 0;
  for (auto _ : state) {
    state.PauseTiming();
    frame = frame == 1 ? 2 : 1;
    person.Integrate(frame);
    state.ResumeTiming();
    mesh = extractor.Extract(person.volume, kMinWeight);
  }
}

/// Samples of the tracked room at every `stride`-th pixel.
std::vector<ModelSample> RoomSamples(const SplitFusion& fusion,
                                     const PinholeCamera& camera, int stride) {
  const SurfaceMap& surfaces = fusion.surfaces();
  return BackgroundSamples(
      RenderBackground(surfaces, camera, stride, fusion.options().ray_cast),
      MeanRigidMotion(surfaces.at(0)->graph()), stride);
}

void AssociateRoom(benchmark::State& state) {
  constexpr int kStride = 2;
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const WarpField warp(tracked.fusion.surfaces().at(0)->graph());
  const std::vector<ModelSample> samples =
      RoomSamples(tracked.fusion, tracked.scene.camera(), kStride);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        MakeProjectiveAssociator(tracked.live, 0)
            ->Associate(samples, warp, kStride, {0.10, 0.52, 1.31, false}));
  }
}

void CastRoom(benchmark::State& state) {
  const TwoThreads threads;
  const RoomModel room(PipelineOptions().background.tsdf);
  for (auto _ : state) {
    benchmark::DoNotOptimize(RayCast(room.volume, room.camera_from_canonical,
                                     room.observation.camera,
                                     RayCastOptions()));
  }
}

void ModelMaps(benchmark::State& state) {
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const PinholeCamera& camera = tracked.scene.camera();
  const int stride = tracked.fusion.options().render_stride;
  for (auto _ : state) {
    const MeshRendering meshes =
        RenderMeshes(tracked.fusion.surfaces(), camera.Subsampled(stride));
    benchmark::DoNotOptimize(RoomSamples(tracked.fusion, camera, stride));
    for (const auto& [id, surface] : tracked.fusion.surfaces()) {
      benchmark::DoNotOptimize(VisibleSamples(meshes, *surface, stride));
    }
  }
}

void Split(benchmark::State& state) {
  const SyntheticScene scene{SyntheticOptions()};
  SyntheticFrame rendered = scene.Render(40);
  const PointMap points = ComputePointMap(rendered.frame.depth, scene.camera());
  const std::vector<InstanceMask> detections = scene.Detections(rendered);
  SurfaceSplitter splitter(scene.camera(), LabelTable(), SplitOptions());
  for (auto _ : state) {
    ++rendered.frame.index;
    benchmark::DoNotOptimize(
        splitter.Split(rendered.frame, points, detections, {}));
  }
}

void Network(benchmark::State& state) {
  const char* model = std::getenv("SPLITFUSION_MODEL");
  if (model == nullptr) {
    state.SkipWithError("skipped: no network given; see --model");
    return;
  }
  const char* decoder = std::getenv("SPLITFUSION_DECODER");
  try {
    NetworkOptions options;
    options.model = model;
    options.decoder = decoder != nullptr ? decoder : "yolov8seg";
    NetworkSegmenter segmenter(options);
    const Frame frame = SyntheticScene(SyntheticOptions()).Render(0).frame;
    for (auto _ : state) benchmark::DoNotOptimize(segmenter.Segment(frame));
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
  }
}

/// Room, walking person and soft toy with noise, masks given, as sf_run has it
/// apart from reading and writing files.
void EndToEnd(benchmark::State& state) {
  constexpr int kFrames = 10;
  SyntheticOptions options;
  options.frames = kFrames;
  const SyntheticScene scene(options);
  const std::vector<MaskedFrame> film = FilmScene(scene, kFrames);
  for (auto _ : state) {
    SplitFusion fusion(scene.camera(), PipelineOptions(), LabelTable(),
                       std::make_shared<GivenMasks>(film));
    const Stopwatch watch;
    for (const MaskedFrame& frame : film) fusion.ProcessFrame(frame.frame);
    state.SetIterationTime(watch.Seconds() / kFrames);
  }
}

BENCHMARK(Remesh)->Name("remesh")->UseRealTime();
BENCHMARK(AssociateRoom)->Name("associate")->UseRealTime();
BENCHMARK(CastRoom)->Name("ray_cast")->UseRealTime();
BENCHMARK(ModelMaps)->Name("model_maps")->UseRealTime();
BENCHMARK(Split)->Name("split")->UseRealTime();
BENCHMARK(Network)->Name("network")->UseRealTime();
BENCHMARK(EndToEnd)->Name("end_to_end_frame")->Iterations(1)->UseManualTime();

}  // namespace
}  // namespace splitfusion
