#include "splitfusion/lib/geometry/point_map.h"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// Normal of the plane a u + b v + c = 1 / z fitted to inverse depth. A plane
/// of space is linear in (u, v, 1/z), so that the fit has no bias on slopes:
/// n . X = d with X = z ((u-cx)/fx, (v-cy)/fy, 1) gives
/// 1/z = (n_x (u-cx)/fx + n_y (v-cy)/fy + n_z) / d.
class InverseDepthPlane {
 public:
  void Add(float x, float y, float inverse_z) {
    sx_ += x, sy_ += y, sz_ += inverse_z;
    sxx_ += x * x, sxy_ += x * y, syy_ += y * y;
    sxz_ += x * inverse_z, syz_ += y * inverse_z;
    ++count_;
  }
  int count() const { return count_; }

  /// Plane normal (not normalised) with x, y in normalised image coordinates
  /// relative to (x0, y0); false if the points lie on a line.
  bool Solve(float x0, float y0, Eigen::Vector3f* normal) const {
    const float n = static_cast<float>(count_);
    const float cxx = sxx_ - sx_ * sx_ / n;
    const float cxy = sxy_ - sx_ * sy_ / n;
    const float cyy = syy_ - sy_ * sy_ / n;
    const float cxz = sxz_ - sx_ * sz_ / n;
    const float cyz = syz_ - sy_ * sz_ / n;
    const float determinant = cxx * cyy - cxy * cxy;
    if (!(determinant > 1e-4f * cxx * cyy)) return false;
    const float a = (cxz * cyy - cyz * cxy) / determinant;
    const float b = (cyz * cxx - cxz * cxy) / determinant;
    const float c = (sz_ - a * sx_ - b * sy_) / n;
    *normal = Eigen::Vector3f(a, b, c - a * x0 - b * y0);
    return true;
  }

 private:
  float sx_ = 0, sy_ = 0, sz_ = 0, sxx_ = 0, sxy_ = 0, syy_ = 0;
  float sxz_ = 0, syz_ = 0;
  int count_ = 0;
};

class NormalEstimator {
 public:
  NormalEstimator(const cv::Mat& depth, const PinholeCamera& camera,
                  const PointMapOptions& options)
      : depth_(depth),
        inverse_depth_(1.0 / depth),
        options_(options),
        inverse_fx_(static_cast<float>(1 / camera.fx)),
        inverse_fy_(static_cast<float>(1 / camera.fy)),
        cx_(static_cast<float>(camera.cx)),
        cy_(static_cast<float>(camera.cy)) {}

  cv::Vec3f Point(int u, int v, float z) const {
    return {(u - cx_) * inverse_fx_ * z, (v - cy_) * inverse_fy_ * z, z};
  }

  cv::Vec3f Normal(int u, int v, float z) const {
    const int radius = options_.normal_radius;
    // Below z, so that pixels without depth never pass.
    const float gate = std::min(
        0.9f * z, static_cast<float>(options_.edge_factor * DepthSigma(z) +
                                     options_.edge_offset));
    InverseDepthPlane plane;
    const int v_end = std::min(v + radius, depth_.rows - 1);
    const int u_begin = std::max(u - radius, 0);
    const int u_end = std::min(u + radius, depth_.cols - 1);
    for (int j = std::max(v - radius, 0); j <= v_end; ++j) {
      const float* row = depth_.ptr<float>(j);
      const float* inverse = inverse_depth_.ptr<float>(j);
      for (int i = u_begin; i <= u_end; ++i) {
        if (std::abs(row[i] - z) < gate) {
          plane.Add((i - u) * inverse_fx_, (j - v) * inverse_fy_, inverse[i]);
        }
      }
    }
    // A third of the window: thinner support is an edge or a speck.
    const int window = (2 * radius + 1) * (2 * radius + 1);
    Eigen::Vector3f normal;
    if (3 * plane.count() < window ||
        !plane.Solve((u - cx_) * inverse_fx_, (v - cy_) * inverse_fy_,
                     &normal)) {
      return {0, 0, 0};
    }
    normal.normalize();
    // n . X = d > 0 points away from the camera: turn it round.
    return {-normal.x(), -normal.y(), -normal.z()};
  }

 private:
  const cv::Mat& depth_;
  const cv::Mat inverse_depth_;  // Of no use where there is no depth.
  const PointMapOptions& options_;
  const float inverse_fx_, inverse_fy_, cx_, cy_;
};

}  // namespace

void PointMapOptions::Check() const {
  CheckOption(normal_radius >= 1 && normal_radius <= 20, "normal_radius",
              normal_radius, "1..20 pixels");
  CheckOption(edge_factor > 0, "edge_factor", edge_factor, "a positive number");
  CheckOption(edge_offset >= 0, "edge_offset", edge_offset, "metres >= 0");
}

PointMap ComputePointMap(const cv::Mat& depth, const PinholeCamera& camera,
                         const PointMapOptions& options) {
  if (depth.type() != CV_32FC1 || depth.cols != camera.width ||
      depth.rows != camera.height) {
    throw InputError("depth image is " + std::to_string(depth.cols) + "x" +
                     std::to_string(depth.rows) + " of type " +
                     std::to_string(depth.type()) + ": expected " +
                     std::to_string(camera.width) + "x" +
                     std::to_string(camera.height) + " CV_32FC1");
  }
  options.Check();
  PointMap map;
  map.points.create(depth.size());
  map.normals.create(depth.size());
  const NormalEstimator estimator(depth, camera, options);
  tbb::parallel_for(0, depth.rows, [&](int v) {
    const float* row = depth.ptr<float>(v);
    for (int u = 0; u < depth.cols; ++u) {
      const bool valid = row[u] > 0;
      map.points(v, u) =
          valid ? estimator.Point(u, v, row[u]) : cv::Vec3f(0, 0, 0);
      map.normals(v, u) =
          valid ? estimator.Normal(u, v, row[u]) : cv::Vec3f(0, 0, 0);
    }
  });
  return map;
}

}  // namespace splitfusion
