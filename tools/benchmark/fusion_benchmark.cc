// Fusion of one 640x480 frame at 5 mm voxels (SplitFusion IV-D) beside its
// floor: every voxel that it changes read and written once by the barest loop.

#include <benchmark/benchmark.h>

#include "fusion_floors.h"
#include "fusion_scenes.h"

namespace splitfusion {
namespace {

void Integrate(RoomModel* room) {
  IntegrateRigid(room->observation, room->camera_from_canonical, &room->volume);
}

void RigidRow(benchmark::State& state, bool has_color) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(has_color);
  const auto touched = TouchedLeaves(&room.volume, [&] { Integrate(&room); });
  for (auto _ : state) Integrate(&room);
  state.counters["voxels"] = static_cast<double>(touched.size()) * 512;
  state.counters["leaves"] = static_cast<double>(room.volume.leaf_count());
}

void RigidFloor(benchmark::State& state) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(/*has_color=*/false);
  const auto touched = TouchedLeaves(&room.volume, [&] { Integrate(&room); });
  std::size_t voxels = 0;
  for (auto _ : state) voxels = StreamVoxels(touched);
  state.counters["voxels"] = static_cast<double>(voxels);
}

void RigidPlainLoop(benchmark::State& state) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(/*has_color=*/false);
  const auto touched = TouchedLeaves(&room.volume, [&] { Integrate(&room); });
  std::size_t voxels = 0;
  for (auto _ : state) {
    voxels = FusePlainly(touched, room.observation, room.camera_from_canonical,
                         room.volume.options());
  }
  state.counters["voxels"] = static_cast<double>(voxels);
}

void Allocate(benchmark::State& state) {
  const TwoThreads threads;
  RoomModel& room = FineRoom(/*has_color=*/true);
  for (auto _ : state) {
    AllocateBand(room.observation, room.camera_from_canonical, &room.volume);
  }
}

void WarpedRow(benchmark::State& state) {
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  const auto touched =
      TouchedLeaves(&person.volume, [&] { person.Integrate(1); });
  for (auto _ : state) person.Integrate(1);
  state.counters["voxels"] = static_cast<double>(touched.size()) * 512;
  state.counters["nodes"] = person.graph.size();
}

void WarpedFloor(benchmark::State& state) {
  const TwoThreads threads;
  PersonModel& person = PersonModel::Shared();
  const auto touched =
      TouchedLeaves(&person.volume, [&] { person.Integrate(1); });
  const int nodes = person.graph.size();
  const std::vector<float> maps(12 * nodes, 0.5f);
  std::vector<int> first;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    first.push_back(static_cast<int>(i) % (nodes - kCarriers));
  }
  std::size_t voxels = 0;
  for (auto _ : state) voxels = SkinVoxels(touched, maps, first);
  state.counters["voxels"] = static_cast<double>(voxels);
}

BENCHMARK_CAPTURE(RigidRow, integrate_rigid, /*has_color=*/false)
    ->Name("integrate_rigid")
    ->UseRealTime();
BENCHMARK(RigidFloor)->Name("integrate_rigid/floor")->UseRealTime();
BENCHMARK(RigidPlainLoop)->Name("integrate_rigid/plain_loop")->UseRealTime();
BENCHMARK_CAPTURE(RigidRow, integrate_rigid_color, /*has_color=*/true)
    ->Name("integrate_rigid_color")
    ->UseRealTime();
BENCHMARK(RigidFloor)->Name("integrate_rigid_color/floor")->UseRealTime();
BENCHMARK(Allocate)->Name("allocate_band")->UseRealTime();
BENCHMARK(WarpedRow)->Name("integrate_warped")->UseRealTime();
BENCHMARK(WarpedFloor)->Name("integrate_warped/floor")->UseRealTime();

}  // namespace
}  // namespace splitfusion
