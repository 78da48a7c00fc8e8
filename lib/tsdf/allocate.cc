#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

/// Every other pixel of every other row: blocks are many pixels wide.
constexpr int kPixelStride = 2;

openvdb::Coord LeafOrigin(const Eigen::Vector3d& voxel) {
  const auto align = [](double v) {
    return static_cast<int>(std::floor(v / kLeafSize)) * kLeafSize;
  };
  return {align(voxel.x()), align(voxel.y()), align(voxel.z())};
}

void SortUnique(std::vector<openvdb::Coord>* origins) {
  std::sort(origins->begin(), origins->end());
  origins->erase(std::unique(origins->begin(), origins->end()), origins->end());
}

/// Blocks that the band around the pixels of one row passes through.
std::vector<openvdb::Coord> CollectRow(const DepthObservation& observation,
                                       const Rigid3d& canonical_from_camera,
                                       const TsdfOptions& options, int v) {
  const double step = 0.5 * kLeafSize * options.voxel_size;
  const float* depth = observation.depth[v];
  const std::uint8_t* role = observation.role[v];
  std::vector<openvdb::Coord> origins;
  for (int u = 0; u < observation.camera.width; u += kPixelStride) {
    if (!(depth[u] > 0) ||
        role[u] != static_cast<std::uint8_t>(PixelRole::kWrite)) {
      continue;
    }
    const double z_end = depth[u] + options.truncation;
    for (double z = depth[u] - options.truncation;; z += step) {
      const Eigen::Vector3d point =
          canonical_from_camera *
          observation.camera.BackProject<double>(u, v, std::min(z, z_end));
      const openvdb::Coord origin = LeafOrigin(point / options.voxel_size);
      if (origins.empty() || origins.back() != origin) {
        origins.push_back(origin);
      }
      if (z >= z_end) break;
    }
  }
  SortUnique(&origins);
  return origins;
}

}  // namespace

void AllocateBand(const DepthObservation& observation,
                  const Rigid3d& camera_from_canonical, TsdfVolume* volume) {
  const Rigid3d canonical_from_camera = camera_from_canonical.inverse();
  const int rows = (observation.depth.rows + kPixelStride - 1) / kPixelStride;
  std::vector<std::vector<openvdb::Coord>> found(rows);
  tbb::parallel_for(0, rows, [&](int row) {
    found[row] = CollectRow(observation, canonical_from_camera,
                            volume->options(), row * kPixelStride);
  });
  std::vector<openvdb::Coord> all;
  for (const auto& origins : found) {
    all.insert(all.end(), origins.begin(), origins.end());
  }
  SortUnique(&all);
  for (const openvdb::Coord& origin : all) volume->grids().Touch(origin);
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
