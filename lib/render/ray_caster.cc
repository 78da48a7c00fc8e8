#include "splitfusion/lib/render/ray_caster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/floor_to_int.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/render/internal/depth_bounds.h"
#include "splitfusion/lib/render/internal/ray_bundle.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/trilinear.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;
using internal::kLeafVoxels;
using internal::LeafPlace;
using internal::RayBundle;

/// Reads the cubes of eight voxels that rays cross the surface in.
class CubeReader {
 public:
  explicit CubeReader(const internal::RayVolume& volume) : volume_(volume) {}

  /// Distances of the cube whose low corner is voxel (x, y, z); false where one
  /// of them is unobserved.
  bool Read(int x, int y, int z, float value[2][2][2]) const {
    constexpr int kLast = kLeafSize - 1;
    // Whether the cube reaches into the next block along the axes.
    const int over_x = (x & kLast) == kLast, over_y = (y & kLast) == kLast,
              over_z = (z & kLast) == kLast;
    int leaf[2][2][2];
    for (int i = 0; i <= over_x; ++i) {
      for (int j = 0; j <= over_y; ++j) {
        for (int k = 0; k <= over_z; ++k) {
          leaf[i][j][k] =
              volume_.table.Find((x + i) >> 3, (y + j) >> 3, (z + k) >> 3);
        }
      }
    }
    if ((over_x | over_y | over_z) == 0) {
      const int offset = Offset(x, y, z);
      return ReadInside(volume_.distance[leaf[0][0][0]] + offset,
                        volume_.weight[leaf[0][0][0]] + offset, value);
    }
    bool observed = true;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        for (int k = 0; k < 2; ++k) {
          const int number = leaf[i & over_x][j & over_y][k & over_z];
          const int offset = Offset(x + i, y + j, z + k);
          observed &= volume_.weight[number][offset] > 0;
          value[i][j][k] = volume_.distance[number][offset];
        }
      }
    }
    return observed;
  }

 private:
  static int Offset(int x, int y, int z) {
    return (x & 7) << 6 | (y & 7) << 3 | (z & 7);
  }

  /// The same, given the low corner in the block that holds all eight.
  static bool ReadInside(const float* distance, const float* weight,
                         float value[2][2][2]) {
    bool observed = true;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        for (int k = 0; k < 2; ++k) {
          const int offset = i << 6 | j << 3 | k;
          observed &= weight[offset] > 0;
          value[i][j][k] = distance[offset];
        }
      }
    }
    return observed;
  }

  const internal::RayVolume& volume_;
};

/// Finds where rays that have gone through the surface crossed it.
class Refiner {
 public:
  explicit Refiner(const internal::RayVolume& volume)
      : cubes_(volume),
        origin_(volume.origin[0], volume.origin[1], volume.origin[2]) {}

  /// Finds the crossing near `t`, where the distance is not positive any more,
  /// by Newton's method: the distance is nearly linear along the ray. 0 if it
  /// is not there after all.
  float Refine(const Eigen::Vector3f& step, float t, float voxel_step,
               Eigen::Vector3f* gradient) const {
    const float reach = 2 * voxel_step;
    float place = t - 0.5f * voxel_step;
    constexpr int kRefinements = 2;  // Maths: Newton's method converges.
    for (int i = 0; i < kRefinements; ++i) {
      TrilinearSample sample;
      if (!Interpolate(origin_ + place * step, &sample)) return 0;
      const float slope = sample.gradient.dot(step);
      if (!(slope < 0)) return 0;
      place -= std::clamp(sample.value / slope, -reach, reach);
      *gradient = sample.gradient;
    }
    return std::abs(place - t) <= reach ? place : 0;
  }

  /// The point of index space at z-depth `t` of a ray.
  Eigen::Vector3f Place(const Eigen::Vector3f& step, float t) const {
    return origin_ + t * step;
  }

 private:
  /// Trilinear sample with its gradient; false where a voxel is unobserved.
  bool Interpolate(const Eigen::Vector3f& p, TrilinearSample* sample) const {
    const int x0 = FloorToInt(p.x());
    const int y0 = FloorToInt(p.y());
    const int z0 = FloorToInt(p.z());
    const Eigen::Vector3f f =
        p - Eigen::Vector3f(static_cast<float>(x0), static_cast<float>(y0),
                            static_cast<float>(z0));
    float value[2][2][2];
    if (!cubes_.Read(x0, y0, z0, value)) return false;
    *sample = MixTrilinear(value, f);
    return true;
  }

  CubeReader cubes_;
  Eigen::Vector3f origin_;
};

/// All that the rays of one image have in common.
struct Cast {
  internal::RayVolume volume;
  std::vector<LeafPlace> places;              // Of the blocks with surface.
  std::vector<const std::int32_t*> color;     // By block number.
  std::vector<float> no_distance, no_weight;  // Of the block that is not there.
};

Cast MakeCast(const TsdfVolume& volume, const Rigid3f& camera_from_canonical,
              const RayCastOptions& options) {
  const float voxel = static_cast<float>(volume.options().voxel_size);
  const TsdfVolume::Grids& grids = volume.grids();
  const Eigen::Vector3f origin =
      camera_from_canonical.inverse().translation() / voxel;
  Cast cast{{grids.table,
             {},
             {},
             {0},
             {origin.x(), origin.y(), origin.z()},
             voxel,
             static_cast<float>(options.min_weight)},
            {},
            {nullptr},
            std::vector<float>(kLeafVoxels, 0.0f),
            std::vector<float>(kLeafVoxels, -1.0f)};
  cast.volume.distance.push_back(cast.no_distance.data());
  cast.volume.weight.push_back(cast.no_weight.data());
  for (std::size_t i = 0; i < grids.leaves.size(); ++i) {
    const internal::LeafBuffers& leaf = grids.leaves[i];
    cast.volume.distance.push_back(leaf.distance);
    cast.volume.weight.push_back(leaf.weight);
    cast.volume.has_inside.push_back(grids.states[i].has_inside);
    cast.color.push_back(leaf.color);
    if (grids.states[i].has_inside) {
      cast.places.push_back(internal::PlaceOf(leaf.origin));
    }
  }
  return cast;
}

/// Colour of the voxel nearest to a point of index space; null if there is
/// none.
const std::int32_t* ColorPlace(const Cast& cast, const Eigen::Vector3f& p) {
  const int x = FloorToInt(p.x() + 0.5f);
  const int y = FloorToInt(p.y() + 0.5f);
  const int z = FloorToInt(p.z() + 0.5f);
  const std::int32_t* leaf =
      cast.color[cast.volume.table.Find(x >> 3, y >> 3, z >> 3)];
  return leaf == nullptr ? nullptr
                         : leaf + ((x & 7) << 6 | (y & 7) << 3 | (z & 7));
}

/// The same as BGR, black if there is none.
cv::Vec3b ColorAt(const Cast& cast, const Eigen::Vector3f& p) {
  const std::int32_t* color = ColorPlace(cast, p);
  if (color == nullptr) return {0, 0, 0};
  return {internal::ByteOf(*color, 2), internal::ByteOf(*color, 1),
          internal::ByteOf(*color, 0)};
}

/// Casts the rays of some rows of an image; one object per task.
class RowCaster {
 public:
  RowCaster(const Cast& cast, const internal::DepthBounds& bounds,
            const Rigid3f& camera_from_canonical, int row_begin, int row_end,
            ModelMap* map)
      : cast_(cast),
        bounds_(bounds),
        rotation_(camera_from_canonical.linear()),
        canonical_from_camera_(camera_from_canonical.inverse().linear()),
        v_(row_begin),
        v_end_(row_end),
        map_(map),
        refiner_(cast.volume) {}

  /// Lets the rays walk until there are none left.
  void Run() {
    for (int r = 0; r < RayBundle::kRays; ++r) active_ += Load(r);
    while (active_ > 0) {
      if (!internal::StepRays(cast_.volume, &rays_)) continue;
      for (int r = 0; r < RayBundle::kRays; ++r) {
        if (rays_.stopped[r] == 0) continue;
        const bool hit = rays_.crossing[r] > 0 && Hit(r);
        if (hit || !(rays_.t[r] < rays_.t_end[r])) active_ += Load(r) - 1;
      }
    }
  }

 private:
  /// Puts the next ray in slot `r`; false if there is none.
  bool Load(int r) {
    rays_.t[r] = rays_.t_end[r] = 0;
    for (; v_ < v_end_; ++v_, u_ = 0) {
      while (u_ < map_->camera.width) {
        const int u = u_++;
        if (!bounds_.Range(u, v_, &rays_.t[r], &rays_.t_end[r])) continue;
        Aim(r, u);
        return true;
      }
    }
    rays_.t[r] = rays_.t_end[r] = 0;
    return false;
  }

  void Aim(int r, int u) {
    pixels_[r] = {u, v_};
    directions_[r] = map_->camera.BackProject<float>(
        static_cast<float>(u), static_cast<float>(v_), 1.0f);
    const Eigen::Vector3f step =
        canonical_from_camera_ * directions_[r] / cast_.volume.voxel_size;
    rays_.step_x[r] = step.x();
    rays_.step_y[r] = step.y();
    rays_.step_z[r] = step.z();
    rays_.voxel_step[r] = 1.0f / step.norm();
    rays_.previous[r] = -1;
  }

  /// Writes the pixel of a ray that went through the surface; false if it did
  /// not after all.
  bool Hit(int r) {
    const Eigen::Vector3f step(rays_.step_x[r], rays_.step_y[r],
                               rays_.step_z[r]);
    if (const std::int32_t* color =
            ColorPlace(cast_, refiner_.Place(step, rays_.crossing[r]))) {
      __builtin_prefetch(color);  // Or its neighbour; far from the distances.
    }
    Eigen::Vector3f gradient;
    const float depth = refiner_.Refine(step, rays_.crossing[r],
                                        rays_.voxel_step[r], &gradient);
    if (!(depth > 0)) return false;
    const auto [u, v] = pixels_[r];
    const Eigen::Vector3f normal = (rotation_ * gradient).normalized();
    if (normal.dot(directions_[r]) < 0) {
      map_->points(v, u) = ToCv(depth * directions_[r]);
      map_->normals(v, u) = ToCv(normal);
      map_->color(v, u) = ColorAt(cast_, refiner_.Place(step, depth));
    }
    return true;
  }

  const Cast& cast_;
  const internal::DepthBounds& bounds_;
  Eigen::Matrix3f rotation_, canonical_from_camera_;
  int v_, v_end_, u_ = 0;  // Of the next ray.
  ModelMap* map_;
  Refiner refiner_;
  int active_ = 0;
  RayBundle rays_{};
  std::array<std::pair<int, int>, RayBundle::kRays> pixels_;
  std::array<Eigen::Vector3f, RayBundle::kRays> directions_;
};

}  // namespace

void RayCastOptions::List(OptionList* list) {
  list->Number("min_depth", &min_depth, Range::Above(0), "metres",
               "Nearest depth at which the background is rendered.");
  list->Number("max_depth", &max_depth, Range::Above(0), "metres",
               "Farthest depth at which the background is rendered; more than "
               "ray_min_depth.");
  list->Demand(max_depth > min_depth, "max_depth", "metres > ray_min_depth");
  list->Number("min_weight", &min_weight, Range::AtLeast(0), "",
               "Voxels of the background with less weight are not surface.");
}

ModelMap RayCast(const TsdfVolume& volume, const Rigid3d& camera_from_canonical,
                 const PinholeCamera& camera, const RayCastOptions& options) {
  ModelMap map;
  map.Clear(camera);
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const Cast cast = MakeCast(volume, motion, options);
  const internal::DepthBounds bounds(cast.places, cast.volume.voxel_size,
                                     motion, camera, options);
  constexpr int kRows = 8;  // Speed: of one task.
  tbb::parallel_for(0, (camera.height + kRows - 1) / kRows, [&](int task) {
    RowCaster(cast, bounds, motion, task * kRows,
              std::min(camera.height, (task + 1) * kRows), &map)
        .Run();
  });
  return map;
}

}  // namespace splitfusion
