#include "fusion_floors.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"

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

/// What plain fusion has to know.
struct PlainView {
  const float* depth;  // Row by row, metres, 0 = none.
  int width, height;
  float fx, fy, cx, cy;
  float truncation, max_weight;
  Eigen::Vector3f steps[3];  // From a voxel to the next along an axis.
};

/// A voxel's depth minus its own, or a number below minus the truncation.
inline float PlainDistance(const PlainView& view, float x, float y, float z) {
  const float inverse_z = 1 / z;
  const int u = static_cast<int>(view.fx * x * inverse_z + view.cx + 0.5f);
  const int v = static_cast<int>(view.fy * y * inverse_z + view.cy + 0.5f);
  const bool is_seen =
      z > 0 && u >= 0 && v >= 0 && u < view.width && v < view.height;
  const float depth = is_seen ? view.depth[v * view.width + u] : 0;
  return depth > 0 ? depth - z : -2 * view.truncation;
}

void FuseLeafPlainly(const PlainView& view, const Eigen::Vector3f& base,
                     const LeafBuffers& leaf) {
  for (int i = 0; i < kLeafVoxels; ++i) {
    const Eigen::Vector3f p = base +
                              static_cast<float>(i / 64) * view.steps[0] +
                              static_cast<float>(i / 8 % 8) * view.steps[1] +
                              static_cast<float>(i % 8) * view.steps[2];
    const float sdf = PlainDistance(view, p.x(), p.y(), p.z());
    if (sdf < -view.truncation) continue;
    float& weight = leaf.weight[i];
    float& distance = leaf.distance[i];
    distance =
        (weight * distance + std::min(sdf, view.truncation)) / (weight + 1);
    weight = std::min(weight + 1, view.max_weight);
  }
}

SPLITFUSION_VECTOR_CLONES
float SumLeaf(const float* distance, const float* weight) {
  float sums[kLeafSize] = {};
  for (int i = 0; i < kLeafVoxels; i += kLeafSize) {
    for (int k = 0; k < kLeafSize; ++k) {
      sums[k] += distance[i + k] + weight[i + k];
    }
  }
  return sums[0] + sums[1] + sums[2] + sums[3] + sums[4] + sums[5] + sums[6] +
         sums[7];
}

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

}  // namespace

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

std::size_t StreamVoxels(const std::vector<LeafBuffers>& leaves) {
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    AddToLeaf(leaves[i].distance, leaves[i].weight);
  });
  return leaves.size() * kLeafVoxels;
}

std::size_t FusePlainly(const std::vector<LeafBuffers>& leaves,
                        const DepthObservation& observation,
                        const Rigid3d& camera_from_canonical,
                        const TsdfOptions& options) {
  const PinholeCamera& camera = observation.camera;
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const auto voxel = static_cast<float>(options.voxel_size);
  PlainView view = {observation.depth[0],
                    camera.width,
                    camera.height,
                    static_cast<float>(camera.fx),
                    static_cast<float>(camera.fy),
                    static_cast<float>(camera.cx),
                    static_cast<float>(camera.cy),
                    static_cast<float>(options.truncation),
                    static_cast<float>(options.max_weight),
                    {}};
  for (int axis = 0; axis < 3; ++axis) {
    view.steps[axis] = voxel * motion.linear().col(axis);
  }
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    const openvdb::Coord& origin = leaves[i].origin;
    const Eigen::Vector3f corner(static_cast<float>(origin.x()),
                                 static_cast<float>(origin.y()),
                                 static_cast<float>(origin.z()));
    FuseLeafPlainly(view, motion * (voxel * corner), leaves[i]);
  });
  return leaves.size() * kLeafVoxels;
}

float SumVoxels(const std::vector<LeafBuffers>& leaves) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, leaves.size(), 64), 0.0f,
      [&](const tbb::blocked_range<std::size_t>& range, float sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          sum += SumLeaf(leaves[i].distance, leaves[i].weight);
        }
        return sum;
      },
      [](float a, float b) { return a + b; });
}

std::size_t SkinVoxels(const std::vector<LeafBuffers>& leaves,
                       const std::vector<float>& nodes,
                       const std::vector<int>& first) {
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    SkinLeaf(&nodes[12 * first[i]], leaves[i].distance, leaves[i].weight);
  });
  return leaves.size() * kLeafVoxels;
}

}  // namespace splitfusion
