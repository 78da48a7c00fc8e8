// Projective association (SplitFusion Eq. 5) beside its floor: every sample and
// its live pixel read once, every correspondence written once.

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <vector>

#include "fusion_scenes.h"
#include "splitfusion/lib/association/association.h"

namespace splitfusion {
namespace {

constexpr int kStride = 2;

/// The samples of the room, and how they are carried.
struct RoomSamples {
  RoomSamples() : warp(tracked.fusion.surfaces().at(0)->graph()) {
    const SurfaceMap& surfaces = tracked.fusion.surfaces();
    samples = BackgroundSamples(
        RenderBackground(surfaces, tracked.scene.camera(), kStride,
                         tracked.fusion.options().ray_cast),
        MeanRigidMotion(surfaces.at(0)->graph()), kStride);
  }

  const TrackedScene& tracked = TrackedScene::Shared();
  WarpField warp;
  std::vector<ModelSample> samples;
};

Association AssociateRoom(const RoomSamples& room) {
  return MakeProjectiveAssociator(room.tracked.live, 0)
      ->Associate(room.samples, room.warp, kStride, AssociationGates());
}

void AssociateRow(benchmark::State& state) {
  const TwoThreads threads;
  const RoomSamples room;
  Association association;
  for (auto _ : state) association = AssociateRoom(room);
  state.counters["samples"] = static_cast<double>(room.samples.size());
  state.counters["accepted"] =
      static_cast<double>(association.correspondences.size());
}

Eigen::Vector3f ToEigen(const cv::Vec3f& v) { return {v[0], v[1], v[2]}; }

/// Writes a correspondence whose pixel is known.
void Read(const LiveView& live, const ModelSample& sample,
          Correspondence* out) {
  const int u = static_cast<int>(out->pixel.x());
  const int v = static_cast<int>(out->pixel.y());
  const cv::Vec2f& gradient = live.grey[0].gradient(v, u);
  out->model = sample;
  out->target = ToEigen(live.map.points(v, u));
  out->target_normal = ToEigen(live.map.normals(v, u));
  out->warped_normal = sample.normal;
  out->intensity_gradient = {gradient[0], gradient[1]};
  out->intensity_difference = live.grey[0].value(v, u) - sample.intensity[0];
  out->weight = live.depth(v, u) + live.labels(v, u) + live.uncertain(v, u) +
                live.edges(v, u);
}

void AssociateFloor(benchmark::State& state) {
  const TwoThreads threads;
  const RoomSamples room;
  std::vector<Correspondence> matches = AssociateRoom(room).correspondences;
  std::vector<ModelSample> samples;
  for (Correspondence& match : matches) {
    samples.push_back(match.model);
    match.pixel = {static_cast<float>(match.model.u),
                   static_cast<float>(match.model.v)};
  }
  for (auto _ : state) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end();
                             ++i) {
                          Read(room.tracked.live, samples[i], &matches[i]);
                        }
                      });
  }
  state.counters["accepted"] = static_cast<double>(samples.size());
}

BENCHMARK(AssociateRow)->Name("associate")->UseRealTime();
BENCHMARK(AssociateFloor)->Name("associate/floor")->UseRealTime();

}  // namespace
}  // namespace splitfusion
