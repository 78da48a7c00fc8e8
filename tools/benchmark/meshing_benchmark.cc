// Meshing of a person after one frame and the skinning of its vertices
// (SplitFusion Eq. 3) beside their floors.

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fusion_floors.h"
#include "fusion_scenes.h"
#include "splitfusion/lib/tsdf/mesh_extractor.h"

namespace splitfusion {
namespace {

constexpr double kMinWeight = 0.05;

/// Two frames are fused in turn, so that there is always something new.
void Remesh(benchmark::State& state) {
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
  int kept = 0;
  for (const int from : extractor.kept_from()) kept += from >= 0;
  state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
  state.counters["kept"] = kept;
}

/// Distances and weights of the changed blocks read once, the mesh written
/// once.
void RemeshFloor(benchmark::State& state) {
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  const auto touched =
      TouchedLeaves(&person.volume, [&] { person.Integrate(1); });
  const TriangleMesh mesh = ExtractMesh(person.volume, kMinWeight);
  for (auto _ : state) {
    benchmark::DoNotOptimize(SumVoxels(touched));
    TriangleMesh written = mesh;
    benchmark::DoNotOptimize(written.vertices.data());
  }
  state.counters["vertices"] = static_cast<double>(mesh.vertices.size());
}

void Skin(benchmark::State& state) {
  const TwoThreads threads;
  const PersonModel& person = PersonModel::Shared();
  for (auto _ : state) {
    benchmark::DoNotOptimize(person.index->Skin(person.mesh.vertices).data());
  }
  state.counters["vertices"] = static_cast<double>(person.mesh.vertices.size());
}

/// The weights of Eq. 3 for nodes that are known.
void WeighNodes(const Eigen::Vector3f& point,
                const std::vector<Eigen::Vector3f>& nodes, Skinning* skinning) {
  float distance[kMaxSkinningNodes], farthest = 0, sum = 0;
  for (int k = 0; k < skinning->count; ++k) {
    distance[k] = (nodes[skinning->nodes[k]] - point).norm();
    farthest = std::max(farthest, distance[k]);
  }
  for (int k = 0; k < skinning->count; ++k) {
    const float closeness = 1 - 0.9f * distance[k] / farthest;
    sum += skinning->weights[k] = closeness * closeness;
  }
  for (int k = 0; k < skinning->count; ++k) skinning->weights[k] /= sum;
}

/// The nodes of every vertex are known: they are read and weighed.
void SkinFloor(benchmark::State& state) {
  const TwoThreads threads;
  const PersonModel& person = PersonModel::Shared();
  const std::vector<Eigen::Vector3f>& vertices = person.mesh.vertices;
  const std::vector<Skinning> known = person.index->Skin(vertices);
  std::vector<Eigen::Vector3f> nodes;
  for (const Eigen::Vector3d& p : person.graph.positions) {
    nodes.push_back(p.cast<float>());
  }
  for (auto _ : state) {
    std::vector<Skinning> skinnings(vertices.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end();
                             ++i) {
                          skinnings[i] = known[i];
                          WeighNodes(vertices[i], nodes, &skinnings[i]);
                        }
                      });
    benchmark::DoNotOptimize(skinnings.data());
  }
  state.counters["vertices"] = static_cast<double>(vertices.size());
}

BENCHMARK(Remesh)->Name("remesh")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(RemeshFloor)->Name("remesh/floor")->UseRealTime();
BENCHMARK(Skin)->Name("skin")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(SkinFloor)->Name("skin/floor")->UseRealTime();

}  // namespace
}  // namespace splitfusion
