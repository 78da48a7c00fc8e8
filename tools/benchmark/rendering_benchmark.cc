// Model maps (SplitFusion IV-D) beside their floors: the same pixels written
// from the same data by a loop that knows where everything is.

#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fusion_scenes.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

/// The room as the pipeline models its background.
TsdfOptions RoomVoxels() { return PipelineOptions().background.tsdf; }

const RoomModel& Room() {
  static const RoomModel room(RoomVoxels());
  return room;
}

ModelMap Cast(const RoomModel& room) {
  return RayCast(room.volume, room.camera_from_canonical,
                 room.observation.camera, RayCastOptions());
}

void RayCastRow(benchmark::State& state) {
  const TwoThreads threads;
  const RoomModel& room = Room();
  ModelMap map;
  for (auto _ : state) map = Cast(room);
  cv::Mat depth;
  cv::extractChannel(map.points, depth, 2);
  state.counters["hits"] = cv::countNonZero(depth > 0);
}

/// The cell that a ray meets the surface in.
struct HitCell {
  const float* distance;  // Of its lowest voxel; all eight are in its block.
  const float* weight;
  const std::int32_t* color;
  int u, v;
};

/// Cells of a rendered map, those on a block's border moved inside.
std::vector<HitCell> HitCells(const RoomModel& room, const ModelMap& map) {
  const TsdfVolume::Grids& grids = room.volume.grids();
  const Rigid3d canonical_from_camera = room.camera_from_canonical.inverse();
  std::vector<HitCell> hits;
  for (int v = 0; v < map.points.rows; ++v) {
    for (int u = 0; u < map.points.cols; ++u) {
      const cv::Vec3f& p = map.points(v, u);
      if (!(p[2] > 0)) continue;
      const Eigen::Vector3d at = canonical_from_camera *
                                 Eigen::Vector3d(p[0], p[1], p[2]) /
                                 room.volume.options().voxel_size;
      const Eigen::Vector3i low = at.array().floor().cast<int>();
      const int number =
          grids.table.Find(low.x() >> 3, low.y() >> 3, low.z() >> 3);
      if (number == 0) continue;
      const auto inside = [](int i) { return std::min(i & 7, 6); };
      const int offset =
          inside(low.x()) << 6 | inside(low.y()) << 3 | inside(low.z());
      const auto& leaf = grids.leaves[number - 1];
      hits.push_back({leaf.distance + offset, leaf.weight + offset,
                      leaf.color + offset, u, v});
    }
  }
  return hits;
}

/// Reads eight voxels and one colour, writes one pixel.
void ReadHit(const HitCell& hit, ModelMap* map) {
  float sum[2] = {0, 0}, weight = 0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        sum[i] += hit.distance[64 * i + 8 * j + k];
        weight += hit.weight[64 * i + 8 * j + k];
      }
    }
  }
  map->points(hit.v, hit.u) = {sum[0], sum[1], weight};
  map->normals(hit.v, hit.u) = {sum[1] - sum[0], sum[0], sum[1]};
  map->color(hit.v, hit.u)[0] = static_cast<std::uint8_t>(*hit.color);
}

void RayCastFloor(benchmark::State& state) {
  const TwoThreads threads;
  const RoomModel& room = Room();
  ModelMap map = Cast(room);
  const std::vector<HitCell> hits = HitCells(room, map);
  for (auto _ : state) {
    map.Clear(room.observation.camera);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, hits.size(), 4096),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end();
                             ++i) {
                          ReadHit(hits[i], &map);
                        }
                      });
  }
  state.counters["hits"] = static_cast<double>(hits.size());
}

void ModelMaps(benchmark::State& state) {
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const SurfaceMap& surfaces = tracked.fusion.surfaces();
  const PipelineOptions& options = tracked.fusion.options();
  const PinholeCamera& camera = tracked.scene.camera();
  const int stride = options.render_stride;
  std::size_t samples = 0;
  for (auto _ : state) {
    const MeshRendering meshes =
        RenderMeshes(surfaces, camera.Subsampled(stride));
    const ModelMap background =
        RenderBackground(surfaces, camera, stride, options.ray_cast);
    samples = BackgroundSamples(
                  background, MeanRigidMotion(surfaces.at(0)->graph()), stride)
                  .size();
    for (const auto& [id, surface] : surfaces) {
      samples += VisibleSamples(meshes, *surface, stride).size();
    }
  }
  state.counters["surfaces"] = static_cast<double>(surfaces.size());
  state.counters["samples"] = static_cast<double>(samples);
}

/// Every vertex and triangle of the meshes read once, every pixel of all maps
/// written once.
void ModelMapsFloor(benchmark::State& state) {
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const PinholeCamera camera =
      tracked.scene.camera().Subsampled(tracked.fusion.options().render_stride);
  ModelMap meshes, background;
  for (auto _ : state) {
    meshes.Clear(camera);
    background.Clear(camera);
    for (const auto& [id, surface] : tracked.fusion.surfaces()) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const Eigen::Vector3i& t : surface->mesh().triangles) {
        for (int k = 0; k < 3; ++k) sum += surface->mesh().vertices[t[k]];
      }
      benchmark::DoNotOptimize(sum);
    }
  }
}

/// The largest surface that is drawn from its mesh.
const Surface& LargestMesh(const SurfaceMap& surfaces) {
  const Surface* largest = nullptr;
  for (const auto& [id, surface] : surfaces) {
    if (surface->is_ray_cast()) continue;
    if (largest == nullptr ||
        largest->mesh().triangles.size() < surface->mesh().triangles.size()) {
      largest = surface.get();
    }
  }
  return *largest;
}

void Rasterize(benchmark::State& state) {
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const Surface& surface = LargestMesh(tracked.fusion.surfaces());
  const std::vector<Eigen::Vector3f> vertices = surface.WarpedVertices();
  Raster raster;
  for (auto _ : state) {
    raster.Clear(tracked.scene.camera());
    RasterizeTriangles(vertices, surface.mesh().triangles,
                       tracked.scene.camera(), /*cull_back_faces=*/true, 0,
                       &raster);
  }
  state.counters["triangles"] =
      static_cast<double>(surface.mesh().triangles.size());
  state.counters["pixels"] = cv::countNonZero(raster.depth > 0);
}

/// Corners of every triangle read and projected, then every pixel of the raster
/// written, where a triangle is drawn its weights, too.
void RasterizeFloor(benchmark::State& state) {
  const TwoThreads threads;
  const TrackedScene& tracked = TrackedScene::Shared();
  const Surface& surface = LargestMesh(tracked.fusion.surfaces());
  const std::vector<Eigen::Vector3f> vertices = surface.WarpedVertices();
  const std::vector<Eigen::Vector3i>& triangles = surface.mesh().triangles;
  const PinholeCamera& camera = tracked.scene.camera();
  Raster drawn, raster;
  drawn.Clear(camera);
  RasterizeTriangles(vertices, triangles, camera, true, 0, &drawn);
  std::vector<float> projected(triangles.size());
  for (auto _ : state) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, triangles.size(), 4096),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            float sum = 0;
            for (int k = 0; k < 3; ++k) {
              const auto& p = vertices[triangles[i][k]];
              sum += (p.x() + p.y()) / p.z();
            }
            projected[i] = sum;
          }
        });
    benchmark::DoNotOptimize(projected.data());
    raster.Clear(camera);
    tbb::parallel_for(0, camera.height, [&](int v) {
      for (int u = 0; u < camera.width; ++u) {
        if (!(drawn.depth(v, u) > 0)) continue;
        raster.depth(v, u) = drawn.depth(v, u);
        raster.triangle(v, u) = drawn.triangle(v, u);
        raster.barycentric(v, u) = drawn.barycentric(v, u);
      }
    });
  }
  state.counters["triangles"] = static_cast<double>(triangles.size());
  state.counters["pixels"] = cv::countNonZero(raster.depth > 0);
}

BENCHMARK(RayCastRow)->Name("ray_cast")->UseRealTime();
BENCHMARK(RayCastFloor)->Name("ray_cast/floor")->UseRealTime();
BENCHMARK(ModelMaps)->Name("model_maps")->UseRealTime();
BENCHMARK(ModelMapsFloor)->Name("model_maps/floor")->UseRealTime();
BENCHMARK(Rasterize)->Name("rasterize")->UseRealTime();
BENCHMARK(RasterizeFloor)->Name("rasterize/floor")->UseRealTime();

}  // namespace
}  // namespace splitfusion
