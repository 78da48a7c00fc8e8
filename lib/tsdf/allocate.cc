#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/floor_to_int.h"
#include "splitfusion/lib/tsdf/check_observation.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

/// Every other pixel of every other row.
constexpr int kPixelStride = 2;  // Blocks are many pixels wide.

openvdb::Coord LeafOrigin(const Eigen::Vector3d& voxel) {
  const auto align = [](double v) {
    return FloorToInt(v / kLeafSize) * kLeafSize;
  };
  return {align(voxel.x()), align(voxel.y()), align(voxel.z())};
}

void SortUnique(std::vector<openvdb::Coord>* origins) {
  std::sort(origins->begin(), origins->end());
  origins->erase(std::unique(origins->begin(), origins->end()), origins->end());
}

/// The ray of a pixel counted in blocks: at z-depth z its point is in the block
/// at floor(origin + z * step).
struct BlockRay {
  Eigen::Vector3d origin, step;

  internal::LeafPlace At(double z) const {
    return {FloorToInt(origin.x() + z * step.x()),
            FloorToInt(origin.y() + z * step.y()),
            FloorToInt(origin.z() + z * step.z())};
  }
};

/// Blocks that the band around the pixels of one row passes through and that
/// are not in the volume yet, as often as a pixel does; as often as it takes
/// where a block is too far away for twice as many pixels.
std::vector<openvdb::Coord> MissingInRow(const DepthObservation& observation,
                                         const Rigid3d& canonical_from_camera,
                                         const TsdfVolume& volume, int v) {
  const double block = kLeafSize * volume.options().voxel_size;
  const double truncation = volume.options().truncation;
  const internal::LeafTable& table = volume.grids().table;
  const int least = volume.options().min_block_pixels;
  const float* depth = observation.depth[v];
  const std::uint8_t* role = observation.role[v];
  std::vector<openvdb::Coord> missing;
  BlockRay ray = {canonical_from_camera.translation() / block, {}};
  for (int u = 0; u < observation.camera.width; u += kPixelStride) {
    if (!(depth[u] > 0) ||
        role[u] != static_cast<std::uint8_t>(PixelRole::kWrite)) {
      continue;
    }
    ray.step = canonical_from_camera.linear() *
               observation.camera.BackProject<double>(u, v, 1) / block;
    const double z_begin = depth[u] - truncation;
    const double z_end = depth[u] + truncation;
    const double width =
        observation.camera.fx * block / (kPixelStride * depth[u]);
    const int count = width * width < 2 * least ? least : 1;
    openvdb::Coord last;
    for (double z = z_begin;; z += 0.5 * block) {
      const auto [x, y, z_place] = ray.At(std::min(z, z_end));
      const openvdb::Coord origin(kLeafSize * x, kLeafSize * y,
                                  kLeafSize * z_place);
      const bool again = z > z_begin && origin == last;
      last = origin;
      if (!again && table.Find(x, y, z_place) == 0) {
        missing.insert(missing.end(), count, origin);
      }
      if (z >= z_end) break;
    }
  }
  return missing;
}

/// Those that appear at least `least` times, each once.
std::vector<openvdb::Coord> Repeated(std::vector<openvdb::Coord> origins,
                                     std::ptrdiff_t least) {
  std::sort(origins.begin(), origins.end());
  std::vector<openvdb::Coord> repeated;
  for (auto same = origins.begin(); same != origins.end();) {
    const auto next = std::upper_bound(same, origins.end(), *same);
    if (next - same >= least) repeated.push_back(*same);
    same = next;
  }
  return repeated;
}

}  // namespace

void AllocateBand(const DepthObservation& observation,
                  const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  CheckObservation(observation, volume->options());
  const Rigid3d canonical_from_camera = camera_from_canonical.inverse();
  const int rows = (observation.depth.rows + kPixelStride - 1) / kPixelStride;
  std::vector<std::vector<openvdb::Coord>> found(rows);
  tbb::parallel_for(0, rows, [&](int row) {
    found[row] = MissingInRow(observation, canonical_from_camera, *volume,
                              row * kPixelStride);
  });
  std::vector<openvdb::Coord> all;
  for (const auto& origins : found) {
    all.insert(all.end(), origins.begin(), origins.end());
  }
  const int least = volume->options().min_block_pixels;
  for (const openvdb::Coord& origin : Repeated(std::move(all), least)) {
    volume->grids().Touch(origin);
  }
}

void AllocateAround(const std::vector<Eigen::Vector3d>& points, double radius,
                    TsdfVolume* volume) {
  const double voxel = volume->options().voxel_size;
  std::vector<openvdb::Coord> all;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d offset = Eigen::Vector3d::Constant(radius);
    const openvdb::Coord begin = LeafOrigin((p - offset) / voxel);
    const openvdb::Coord end = LeafOrigin((p + offset) / voxel);
    for (int x = begin.x(); x <= end.x(); x += kLeafSize) {
      for (int y = begin.y(); y <= end.y(); y += kLeafSize) {
        for (int z = begin.z(); z <= end.z(); z += kLeafSize) {
          const Eigen::Vector3d low = Eigen::Vector3d(x, y, z) * voxel;
          const Eigen::Vector3d high =
              low + Eigen::Vector3d::Constant(kLeafSize * voxel);
          const Eigen::Vector3d nearest = p.cwiseMax(low).cwiseMin(high);
          if ((nearest - p).squaredNorm() <= radius * radius) {
            all.emplace_back(x, y, z);
          }
        }
      }
    }
  }
  SortUnique(&all);
  for (const openvdb::Coord& origin : all) volume->grids().Touch(origin);
}

}  // namespace splitfusion
