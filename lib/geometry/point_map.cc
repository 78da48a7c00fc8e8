#include "splitfusion/lib/geometry/point_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/geometry/window_planes.h"

namespace splitfusion {
namespace {

class NormalEstimator {
 public:
  NormalEstimator(const cv::Mat& depth, const PinholeCamera& camera,
                  const PointMapOptions& options)
      : options_(options),
        noise_(camera.noise),
        width_(depth.cols),
        inverse_fx_(static_cast<float>(1 / camera.fx)),
        inverse_fy_(static_cast<float>(1 / camera.fy)),
        cx_(static_cast<float>(camera.cx)),
        cy_(static_cast<float>(camera.cy)) {
    // Windows may reach over the border, where there is no depth.
    const int radius = options.radius;
    cv::copyMakeBorder(
        depth, depth_, radius, radius, radius, radius + kWindowPixels,
        cv::BORDER_CONSTANT | cv::BORDER_ISOLATED, cv::Scalar(0));
    inverse_depth_ = 1.0 / depth_;
  }

  cv::Vec3f Point(int u, int v, float z) const {
    return {(u - cx_) * inverse_fx_ * z, (v - cy_) * inverse_fy_ * z, z};
  }

  /// Normals of a row of the image; 0 where there is no depth.
  void Normals(int v, cv::Vec3f* normals) const {
    const int radius = options_.radius;
    for (int u = 0; u < width_; u += kWindowPixels) {
      const float* depth = depth_[v + radius] + u + radius;
      float gates[kWindowPixels];
      for (int i = 0; i < kWindowPixels; ++i) gates[i] = Gate(depth[i]);
      WindowSums sums;
      SumWindows(
          {depth_[v] + u, inverse_depth_[v] + u,
           static_cast<int>(depth_.step1()), radius, inverse_fx_, inverse_fy_},
          depth, gates, &sums);
      WindowCenters centers;
      for (int i = 0; i < kWindowPixels; ++i) {
        centers.x[i] = (u + i - cx_) * inverse_fx_;
      }
      centers.y = (v - cy_) * inverse_fy_;
      // A third of the window: thinner support is an edge or a speck.
      const int side = 2 * radius + 1;
      WindowNormals fitted;
      FitWindowPlanes(sums, centers, (side * side + 2) / 3, &fitted);
      const int count = std::min(kWindowPixels, width_ - u);
      for (int i = 0; i < count; ++i) {
        normals[u + i] = depth[i] > 0
                             ? cv::Vec3f(fitted.x[i], fitted.y[i], fitted.z[i])
                             : cv::Vec3f(0, 0, 0);
      }
    }
  }

 private:
  /// Difference of depth up to which pixels count, metres; below `z`, so that
  /// those without depth never pass.
  float Gate(float z) const {
    const DepthTolerance<double> edge = {options_.edge_offset,
                                         options_.edge_factor};
    constexpr float kBelow = 0.9f;  // Maths.
    return std::min(kBelow * z, static_cast<float>(edge.At(z, noise_)));
  }

  const PointMapOptions& options_;
  const DepthNoise noise_;
  const int width_;
  const float inverse_fx_, inverse_fy_, cx_, cy_;
  cv::Mat_<float> depth_;          // With a border of no depth.
  cv::Mat_<float> inverse_depth_;  // Of no use where there is no depth.
};

}  // namespace

float PointMap::NormalSigma(float z, double focal) const {
  if (radius == 0 || !(z > 0)) return 0;
  // Sum of the squared distances from the middle, in columns, of all pixels.
  const int side = 2 * radius + 1;
  const double spread = std::sqrt(side * side * (side * side - 1) / 12.0);
  return static_cast<float>(noise.Sigma(z) * focal / (z * spread));
}

void PointMapOptions::List(OptionList* list) {
  list->Number("radius", &radius, {1, 20}, "pixels",
               "Half width of the window that a live normal is fitted to.");
  list->Number("edge_factor", &edge_factor, Range::Above(0), "",
               "Depth that differs from its middle by so many times the noise "
               "does not count.");
  list->Number("edge_offset", &edge_offset, Range::AtLeast(0), "metres",
               "Added to that difference.");
}

void PointMapOptions::Check() const { CheckOptions(*this); }

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
  map.noise = camera.noise;
  map.radius = options.radius;
  map.points.create(depth.size());
  map.normals.create(depth.size());
  const NormalEstimator estimator(depth, camera, options);
  tbb::parallel_for(0, depth.rows, [&](int v) {
    const float* row = depth.ptr<float>(v);
    for (int u = 0; u < depth.cols; ++u) {
      const bool valid = row[u] > 0;
      map.points(v, u) =
          valid ? estimator.Point(u, v, row[u]) : cv::Vec3f(0, 0, 0);
    }
    estimator.Normals(v, map.normals[v]);
  });
  return map;
}

}  // namespace splitfusion
