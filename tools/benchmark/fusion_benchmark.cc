// Fusion of one 640x480 frame at 5 mm voxels (SplitFusion IV-D) beside its
// floor: every voxel that it changes read and written once by the barest loop.

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <functional>
#include <vector>

#include "fusion_scenes.h"
#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;
using internal::kLeafVoxels;
using internal::LeafBuffers;

SPLITFUSION_VECTOR_CLONES
void AddToLeaf(float* __restrict distance, float* __restrict weight) {
  for (int i = 0; i < kLeafVoxels; ++i) {
    distance[i] += 1e-9f;
    weight[i] += 1e-9f;
  }
}

constexpr int kCarriers = 6;  // Nodes that carry a point.

/// Place of a lattice point: a blend of affine maps.
inline float Blend(const float* maps, int axis, const float point[3]) {
  float sum = 0;
  for (int k = 0; k < kCarriers; ++k) {
    const float* row = maps + 12 * k + 4 * axis;
    sum += row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
  }
  return sum;
}

/// One cell of 4 x 4 x 4 voxels, given the three coordinates at its lowest
/// voxel and their steps along the axes.
inline void AddToCell(const float low[3], const float step[3][3],
                      float* __restrict distance, float* __restrict weight) {
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      float* d = distance + kLeafSize * (kLeafSize * x + y);
      float* w = weight + kLeafSize * (kLeafSize * x + y);
      for (int z = 0; z < 4; ++z) {
        float place = 0;
        for (int axis = 0; axis < 3; ++axis) {
          place += low[axis] + x * step[0][axis] + y * step[1][axis] +
                   z * step[2][axis];
        }
        d[z] += 1e-9f * place;
        w[z] += 1e-9f;
      }
    }
  }
}

SPLITFUSION_VECTOR_CLONES
void SkinLeaf(const float* maps, float* distance, float* weight) {
  for (int cell = 0; cell < 8; ++cell) {
    const int x = cell >> 2, y = (cell >> 1) & 1, z = cell & 1;
    const float point[3] = {0.02f * x, 0.02f * y, 0.02f * z};
    float low[3], step[3][3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = Blend(maps, axis, point);
      for (int along = 0; along < 3; ++along) {
        step[along][axis] = 0.005f * maps[4 * axis + along];
      }
    }
    const int offset = 4 * (64 * x + 8 * y + z);
    AddToCell(low, step, distance + offset, weight + offset);
  }
}

/// Blocks of which an integration changes at least one distance or weight:
/// `integrate` is run once on the volume.
std::vector<LeafBuffers> TouchedLeaves(TsdfVolume* volume,
                                       const std::function<void()>& integrate) {
  constexpr std::size_t kBytes = sizeof(float) * kLeafVoxels;
  const std::vector<LeafBuffers>& leaves = volume->grids().leaves;
  std::vector<float> before(2 * kLeafVoxels * leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    float* copy = &before[2 * kLeafVoxels * i];
    std::memcpy(copy, leaves[i].distance, kBytes);
    std::memcpy(copy + kLeafVoxels, leaves[i].weight, kBytes);
  }
  integrate();
  std::vector<LeafBuffers> touched;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const float* copy = &before[2 * kLeafVoxels * i];
    if (std::memcmp(copy, leaves[i].distance, kBytes) != 0 ||
        std::memcmp(copy + kLeafVoxels, leaves[i].weight, kBytes) != 0) {
      touched.push_back(leaves[i]);
    }
  }
  return touched;
}

/// Reads and writes distance and weight of every voxel once, in parallel, with
/// one addition each.
void StreamVoxels(const std::vector<LeafBuffers>& leaves) {
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    AddToLeaf(leaves[i].distance, leaves[i].weight);
  });
}

/// StreamVoxels(), and adds to every distance a place that is blended from
/// affine maps of six of so many nodes at every fourth voxel and interpolated
/// in between: the barest skinning.
void SkinVoxels(const std::vector<LeafBuffers>& leaves, int nodes) {
  const std::vector<float> maps(12 * nodes, 0.5f);
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    const std::size_t first = i % (nodes - kCarriers);
    SkinLeaf(&maps[12 * first], leaves[i].distance, leaves[i].weight);
  });
}

void Integrate(RoomModel* room) {
  IntegrateRigid(room->observation, room->camera_from_canonical, &room->volume);
}

void Rigid(benchmark::State& state, bool has_color) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(has_color);
  for (auto _ : state) Integrate(&room);
}

void RigidFloor(benchmark::State& state) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(/*has_color=*/false);
  const auto touched = TouchedLeaves(&room.volume, [&] { Integrate(&room); });
  for (auto _ : state) StreamVoxels(touched);
}

void Warped(benchmark::State& state) {
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  for (auto _ : state) person.Integrate(1);
}

void WarpedFloor(benchmark::State& state) {
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  const auto touched =
      TouchedLeaves(&person.volume, [&] { person.Integrate(1); });
  for (auto _ : state) SkinVoxels(touched, person.graph.size());
}

BENCHMARK_CAPTURE(Rigid, plain, /*has_color=*/false)
    ->Name("integrate_rigid")
    ->UseRealTime();
BENCHMARK(RigidFloor)->Name("integrate_rigid/floor")->UseRealTime();
BENCHMARK_CAPTURE(Rigid, color, /*has_color=*/true)
    ->Name("integrate_rigid_color")
    ->UseRealTime();
BENCHMARK(RigidFloor)->Name("integrate_rigid_color/floor")->UseRealTime();
BENCHMARK(Warped)->Name("integrate_warped")->UseRealTime();
BENCHMARK(WarpedFloor)->Name("integrate_warped/floor")->UseRealTime();

}  // namespace
}  // namespace splitfusion
