#include "splitfusion/lib/render/ray_caster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {
namespace {

using internal::kLeafSize;

using DistanceLeaf = openvdb::FloatTree::LeafNodeType;
using DistanceAccessor = openvdb::FloatGrid::ConstAccessor;
using ColorAccessor = openvdb::Vec3SGrid::ConstAccessor;

/// A sample of the volume at a point of index space.
struct Sample {
  float distance = 0;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();  // Per voxel.
};

/// Nearest and farthest depth of any block behind tiles of the image: where a
/// ray has to look. A tile without a block has near > far.
class DepthBounds {
 public:
  DepthBounds(const TsdfVolume& volume, const Rigid3f& camera_from_canonical,
              const PinholeCamera& camera, const RayCastOptions& options)
      : columns_((camera.width + kTile - 1) / kTile),
        rows_((camera.height + kTile - 1) / kTile),
        near_(static_cast<float>(options.min_depth)),
        far_(static_cast<float>(options.max_depth)),
        bounds_(static_cast<std::size_t>(columns_) * rows_, {far_, near_}) {
    const float voxel = static_cast<float>(volume.options().voxel_size);
    const float radius = 0.87f * voxel * kLeafSize;
    for (auto leaf = volume.grids().distance->tree().cbeginLeaf(); leaf;
         ++leaf) {
      const openvdb::Coord o = leaf->origin();
      const Eigen::Vector3f center(static_cast<float>(o.x()),
                                   static_cast<float>(o.y()),
                                   static_cast<float>(o.z()));
      const float half = 0.5f * (kLeafSize - 1);
      Add(camera,
          camera_from_canonical *
              (voxel * (center + Eigen::Vector3f::Constant(half))),
          radius);
    }
  }

  /// Depth range of the ray through pixel (u, v); false if there is nothing.
  bool Range(int u, int v, float* near, float* far) const {
    const auto& bound =
        bounds_[static_cast<std::size_t>(v / kTile) * columns_ + u / kTile];
    *near = bound.first, *far = bound.second;
    return *near < *far;
  }

 private:
  static constexpr int kTile = 8;  // Pixels.

  void Add(const PinholeCamera& camera, const Eigen::Vector3f& center,
           float radius) {
    if (center.z() + radius < near_ || center.z() - radius > far_) return;
    const float z = std::max(center.z() - radius, near_);
    const float reach_u = static_cast<float>(camera.fx) * radius / z;
    const float reach_v = static_cast<float>(camera.fy) * radius / z;
    // Where the sphere reaches behind the near plane its image is unbounded.
    const Eigen::Vector2f pixel = camera.Project<float>(
        {center.x(), center.y(), std::max(center.z(), near_)});
    const auto tile = [](float p, int count) {
      return std::clamp(static_cast<int>(std::floor(p / kTile)), 0, count - 1);
    };
    if (pixel.x() + reach_u < 0 || pixel.y() + reach_v < 0 ||
        pixel.x() - reach_u > static_cast<float>(camera.width) ||
        pixel.y() - reach_v > static_cast<float>(camera.height)) {
      return;
    }
    const int u_end = tile(pixel.x() + reach_u, columns_);
    const int v_end = tile(pixel.y() + reach_v, rows_);
    for (int v = tile(pixel.y() - reach_v, rows_); v <= v_end; ++v) {
      for (int u = tile(pixel.x() - reach_u, columns_); u <= u_end; ++u) {
        auto& bound = bounds_[static_cast<std::size_t>(v) * columns_ + u];
        bound.first = std::min(bound.first, z);
        bound.second =
            std::min(far_, std::max(bound.second, center.z() + radius));
      }
    }
  }

  int columns_, rows_;
  float near_, far_;
  std::vector<std::pair<float, float>> bounds_;
};

/// Casts rays into one volume; one object per task.
class Caster {
 public:
  Caster(const TsdfVolume& volume, const Rigid3f& camera_from_canonical,
         const RayCastOptions& options)
      : voxel_(static_cast<float>(volume.options().voxel_size)),
        canonical_from_camera_(camera_from_canonical.inverse()),
        options_(options),
        distance_(volume.grids().distance->getConstAccessor()),
        weight_(volume.grids().weight->getConstAccessor()),
        color_(volume.grids().color->getConstAccessor()) {}

  /// First surface along the ray through z-depth 1 point `direction` of the
  /// camera frame, between z-depths `t` and `t_end`. Returns its z-depth, 0 if
  /// there is none; `gradient` is in the canonical frame.
  float Cast(const Eigen::Vector3f& direction, float t, float t_end,
             Eigen::Vector3f* position, Eigen::Vector3f* gradient) {
    // Index space position at z-depth t: origin + t * step.
    const Eigen::Vector3f origin =
        canonical_from_camera_.translation() / voxel_;
    const Eigen::Vector3f step =
        canonical_from_camera_.linear() * direction / voxel_;
    const float voxel_step = 1.0f / step.norm();  // z-depth of one voxel.
    float previous = -1;  // Distance at the sample before; < 0: none.
    while (t < t_end) {
      const Eigen::Vector3f p = origin + t * step;
      const openvdb::Coord at = Nearest(p);
      const DistanceLeaf* leaf = distance_.probeConstLeaf(at);
      if (leaf == nullptr) {
        previous = -1;
        t = SkipBlock(p, step, t, at);
        continue;
      }
      const openvdb::Index offset = DistanceLeaf::coordToOffset(at);
      const float weight = weight_.getValue(at);
      const float distance = leaf->getValue(offset);
      if (weight < static_cast<float>(options_.min_weight)) {
        previous = -1;
      } else {
        if (previous > 0 && distance <= 0) {
          const float hit = Refine(origin, step, t, voxel_step, gradient);
          if (hit > 0) {
            *position = origin + hit * step;
            return hit;
          }
        }
        // Behind a crossing that could not be refined it is tried again.
        if (distance > 0) previous = distance;
      }
      // Distances are along the ray to within the slope: half is safe.
      const float free =
          distance > 0 && weight > 0 ? 0.5f * distance / voxel_ : 0;
      t += voxel_step * std::max(free, 0.7f);
    }
    return 0;
  }

  /// Interpolated colour at a point of index space, BGR.
  cv::Vec3b Color(const Eigen::Vector3f& p) {
    const openvdb::Vec3s rgb = color_.getValue(Nearest(p));
    const auto byte = [](float v) {
      return cv::saturate_cast<std::uint8_t>(v * 255);
    };
    return {byte(rgb[2]), byte(rgb[1]), byte(rgb[0])};
  }

 private:
  static openvdb::Coord Nearest(const Eigen::Vector3f& p) {
    return {static_cast<int>(std::floor(p.x() + 0.5f)),
            static_cast<int>(std::floor(p.y() + 0.5f)),
            static_cast<int>(std::floor(p.z() + 0.5f))};
  }

  /// z-depth just behind the empty block that holds `at`.
  static float SkipBlock(const Eigen::Vector3f& p, const Eigen::Vector3f& step,
                         float t, const openvdb::Coord& at) {
    float leave = 1e9f;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = static_cast<float>(at[axis] & ~(kLeafSize - 1)) - 0.5f;
      const float wall = step[axis] > 0 ? low + kLeafSize : low;
      if (std::abs(step[axis]) > 1e-9f) {
        leave = std::min(leave, (wall - p[axis]) / step[axis]);
      }
    }
    return t + std::max(leave, 0.0f) + 1e-4f;
  }

  /// Trilinear sample with its gradient; false where a voxel is unobserved.
  bool Interpolate(const Eigen::Vector3f& p, Sample* sample) {
    const Eigen::Vector3f floor = p.array().floor();
    const Eigen::Vector3f f = p - floor;
    const openvdb::Coord base(static_cast<int>(floor.x()),
                              static_cast<int>(floor.y()),
                              static_cast<int>(floor.z()));
    float value[2][2][2];
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 2; ++y) {
        for (int z = 0; z < 2; ++z) {
          const openvdb::Coord at = base.offsetBy(x, y, z);
          if (!(weight_.getValue(at) > 0)) return false;
          value[x][y][z] = distance_.getValue(at);
        }
      }
    }
    const auto mix = [](float a, float b, float w) { return a + w * (b - a); };
    float by_x[2], slab[2][2], dz[2];
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 2; ++y) {
        slab[x][y] = mix(value[x][y][0], value[x][y][1], f.z());
      }
      by_x[x] = mix(slab[x][0], slab[x][1], f.y());
      dz[x] = mix(value[x][0][1] - value[x][0][0],
                  value[x][1][1] - value[x][1][0], f.y());
    }
    sample->distance = mix(by_x[0], by_x[1], f.x());
    sample->gradient.x() = by_x[1] - by_x[0];
    sample->gradient.y() =
        mix(slab[0][1] - slab[0][0], slab[1][1] - slab[1][0], f.x());
    sample->gradient.z() = mix(dz[0], dz[1], f.x());
    return true;
  }

  /// Finds the crossing near `t`, where the distance is not positive any more,
  /// by false position: the distance is nearly linear along the ray.
  float Refine(const Eigen::Vector3f& origin, const Eigen::Vector3f& step,
               float t, float voxel_step, Eigen::Vector3f* gradient) {
    float near = t - 2.5f * voxel_step;
    float far = t + voxel_step;
    Sample sample, at_near, at_far;
    if (!Interpolate(origin + far * step, &at_far)) return 0;
    if (!Interpolate(origin + near * step, &at_near)) return 0;
    if (at_near.distance <= 0 || at_far.distance > 0) return 0;
    constexpr int kRefinements = 3;
    for (int i = 0; i < kRefinements; ++i) {
      const float ratio =
          at_near.distance / (at_near.distance - at_far.distance);
      const float middle =
          near + std::clamp(ratio, 0.05f, 0.95f) * (far - near);
      if (!Interpolate(origin + middle * step, &sample)) return 0;
      if (sample.distance > 0) {
        near = middle, at_near = sample;
      } else {
        far = middle, at_far = sample;
      }
    }
    *gradient = sample.gradient;
    const float ratio = at_near.distance / (at_near.distance - at_far.distance);
    return near + ratio * (far - near);
  }

  float voxel_;
  Rigid3f canonical_from_camera_;
  const RayCastOptions& options_;
  DistanceAccessor distance_;
  openvdb::FloatGrid::ConstAccessor weight_;
  ColorAccessor color_;
};

cv::Vec3f ToCv(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

/// Casts the rays of all pixels, rows in parallel; calls
/// visit(v, u, direction, depth, position, gradient, caster) for those that
/// hit.
template <typename Visit>
void CastAll(const TsdfVolume& volume, const Rigid3d& camera_from_canonical,
             const PinholeCamera& camera, const RayCastOptions& options,
             const Visit& visit) {
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const DepthBounds bounds(volume, motion, camera, options);
  tbb::parallel_for(
      tbb::blocked_range<int>(0, camera.height, 8),
      [&](const tbb::blocked_range<int>& rows) {
        Caster caster(volume, motion, options);
        for (int v = rows.begin(); v < rows.end(); ++v) {
          for (int u = 0; u < camera.width; ++u) {
            float near = 0, far = 0;
            if (!bounds.Range(u, v, &near, &far)) continue;
            const Eigen::Vector3f direction = camera.BackProject<float>(
                static_cast<float>(u), static_cast<float>(v), 1.0f);
            Eigen::Vector3f position, gradient;
            const float depth =
                caster.Cast(direction, near, far, &position, &gradient);
            if (depth > 0) {
              visit(v, u, direction, depth, position, gradient, &caster);
            }
          }
        }
      });
}

}  // namespace

void RayCastOptions::Check() const {
  CheckOption(min_depth > 0, "ray_min_depth", min_depth, "metres > 0");
  CheckOption(max_depth > min_depth, "ray_max_depth", max_depth,
              "metres > ray_min_depth");
  CheckOption(min_weight >= 0, "ray_min_weight", min_weight, ">= 0");
}

ModelMap RayCast(const TsdfVolume& volume, const Rigid3d& camera_from_canonical,
                 const PinholeCamera& camera, const RayCastOptions& options) {
  ModelMap map;
  map.Clear(camera);
  const Eigen::Matrix3f rotation = camera_from_canonical.linear().cast<float>();
  CastAll(volume, camera_from_canonical, camera, options,
          [&](int v, int u, const Eigen::Vector3f& direction, float depth,
              const Eigen::Vector3f& position, const Eigen::Vector3f& gradient,
              Caster* caster) {
            const Eigen::Vector3f normal = (rotation * gradient).normalized();
            if (!(normal.dot(direction) < 0)) return;
            map.points(v, u) = ToCv(depth * direction);
            map.normals(v, u) = ToCv(normal);
            map.color(v, u) = caster->Color(position);
          });
  return map;
}

}  // namespace splitfusion
