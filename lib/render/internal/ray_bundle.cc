#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/render/internal/ray_bundle.h"

#include <cmath>
#include <cstdint>

#include "splitfusion/lib/base/floor_to_int.h"
#include "splitfusion/lib/base/vector_clones.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr int kRays = RayBundle::kRays;

/// Rays step as far as this at least, voxels.
constexpr float kLeastStep = 0.7f;

/// Voxels that rays are in.
struct Places {
  float x[kRays], y[kRays], z[kRays];  // Index space.
  std::int32_t i[kRays], j[kRays], k[kRays];
};

/// What rays read at their voxels.
struct Samples {
  float distance[kRays], weight[kRays];
  float has_inside[kRays];  // Of the block.
};

/// Where rays are at their z-depths, and in which voxels.
SPLITFUSION_INLINE void FindPlaces(const RayVolume& volume,
                                   const RayBundle& rays, Places* at) {
  for (int r = 0; r < kRays; ++r) {
    at->x[r] = volume.origin[0] + rays.t[r] * rays.step_x[r];
    at->y[r] = volume.origin[1] + rays.t[r] * rays.step_y[r];
    at->z[r] = volume.origin[2] + rays.t[r] * rays.step_z[r];
    at->i[r] = FloorToInt(at->x[r] + 0.5f);
    at->j[r] = FloorToInt(at->y[r] + 0.5f);
    at->k[r] = FloorToInt(at->z[r] + 0.5f);
  }
}

/// Reads the voxels; all are asked for before the first is read.
SPLITFUSION_INLINE void ReadSamples(const RayVolume& volume, const Places& at,
                                    Samples* samples) {
  const float* distance[kRays];
  const float* weight[kRays];
  for (int r = 0; r < kRays; ++r) {
    const std::int32_t leaf =
        volume.table.Find(at.i[r] >> 3, at.j[r] >> 3, at.k[r] >> 3);
    const std::int32_t offset =
        (at.i[r] & 7) << 6 | (at.j[r] & 7) << 3 | (at.k[r] & 7);
    distance[r] = volume.distance[leaf] + offset;
    weight[r] = volume.weight[leaf] + offset;
    __builtin_prefetch(distance[r]);
    __builtin_prefetch(weight[r]);
    samples->has_inside[r] = volume.has_inside[leaf];
  }
  for (int r = 0; r < kRays; ++r) {
    samples->distance[r] = *distance[r];
    samples->weight[r] = *weight[r];
  }
}

/// Advance in z-depth to where a ray leaves its block along one axis.
inline float ToWall(float place, std::int32_t voxel, float step) {
  const float low = static_cast<float>(voxel & ~7) - 0.5f;
  const float wall = step > 0 ? low + 8.0f : low;  // Layout.
  const float advance = (wall - place) / step;
  return std::abs(step) > 1e-9f ? advance : 1e9f;
}

inline float Lower(float a, float b) { return b < a ? b : a; }

}  // namespace

SPLITFUSION_VECTOR_CLONES
bool StepRays(const RayVolume& volume, RayBundle* rays) {
  Places at;
  FindPlaces(volume, *rays, &at);
  Samples sample;
  ReadSamples(volume, at, &sample);
  int any_stopped = 0;
  for (int r = 0; r < kRays; ++r) {
    const float t = rays->t[r];
    const bool at_rest = !(t < rays->t_end[r]);
    const bool unseen = sample.weight[r] < volume.min_weight;
    const bool positive = sample.distance[r] > 0;
    const bool crosses =
        !at_rest & !unseen & (rays->previous[r] > 0) & !positive;
    rays->crossing[r] = crosses ? t : 0.0f;
    // Behind a crossing that could not be refined it is tried again.
    const float seen = positive ? sample.distance[r] : rays->previous[r];
    rays->previous[r] = unseen ? -1.0f : seen;
    // Distances are along the ray to within the slope: half is safe.
    const float half = 0.5f * sample.distance[r] / volume.voxel_size;
    const float free = positive & (sample.weight[r] > 0) ? half : 0.0f;
    const float walked =
        t + rays->voxel_step[r] * (free < kLeastStep ? kLeastStep : free);
    float leave = Lower(1e9f, ToWall(at.x[r], at.i[r], rays->step_x[r]));
    leave = Lower(leave, ToWall(at.y[r], at.j[r], rays->step_y[r]));
    leave = Lower(leave, ToWall(at.z[r], at.k[r], rays->step_z[r]));
    const float skipped = t + (leave < 0 ? 0.0f : leave) + 1e-4f;  // Maths.
    // The last sample of a block tells whether the surface is crossed next.
    const float crossed = skipped - rays->voxel_step[r];
    const float to_end = crossed > walked ? crossed : walked;
    const float there = sample.has_inside[r] > 0 ? walked : to_end;
    const float next = sample.weight[r] < 0 ? skipped : there;
    const bool ends = !at_rest & !(next < rays->t_end[r]);
    rays->stopped[r] = crosses | ends ? 1 : 0;
    any_stopped |= rays->stopped[r];
    rays->t[r] = at_rest ? t : next;
  }
  return any_stopped != 0;
}

}  // namespace internal
}  // namespace splitfusion
