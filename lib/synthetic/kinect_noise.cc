#include "splitfusion/lib/synthetic/kinect_noise.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

/// A jump of depth that is an edge, as part of the depth.
constexpr float kEdgePart = 0.03f;
/// Width of the ramps at the far end of the range and at grazing angles.
constexpr float kRangeRamp = 0.7f;    // Metres.
constexpr float kGrazingRamp = 0.1f;  // Of the cosine.
constexpr float kBlobSigmas = 3.4f;

/// Independent streams of random numbers.
enum Stream : std::uint32_t {
  kAxialShared = 1,
  kAxialOwn,
  kLateralX,
  kLateralY,
  kBlobs,
  kLoss,
};

class NoiseModel {
 public:
  NoiseModel(const cv::Mat_<float>& depth, const PinholeCamera& camera,
             std::uint32_t seed, const KinectNoiseOptions& options)
      : exact_(depth), camera_(camera), seed_(seed), options_(options) {
    const double scale = camera.width / 640.0;
    const double shared = options.correlation_px * scale;
    axial_ = std::sqrt(options.correlated_part) * Field(shared, kAxialShared) +
             std::sqrt(1 - options.correlated_part) * Field(0, kAxialOwn);
    const double shift = options.lateral_px * scale;
    shift_x_ = shift * Field(shared, kLateralX);
    shift_y_ = shift * Field(shared, kLateralY);
    blobs_ = Field(1.5 * scale, kBlobs);
    min_cosine_ = static_cast<float>(
        std::cos(options.grazing_degrees * kPi<double> / 180));
  }

  void MeasureRow(int v, float* out) const {
    const std::vector<bool> shadow = ProjectorShadow(v);
    for (int u = 0; u < exact_.cols; ++u) {
      const float z = DisplacedDepth(v, u);
      const bool lost = z <= 0 || shadow[u] || IsLost(v, u, z);
      const float measured = lost ? 0 : Measure(v, u, z);
      const bool in_range =
          measured >= options_.min_depth && measured <= options_.max_depth;
      out[u] = in_range ? measured : 0;
    }
  }

 private:
  cv::Mat_<float> Field(double correlation_px, Stream stream) const {
    return CorrelatedNoise(exact_.size(), correlation_px,
                           HashCell(static_cast<int>(stream), 0, 0, seed_));
  }

  float At(int v, int u) const {
    return exact_(std::clamp(v, 0, exact_.rows - 1),
                  std::clamp(u, 0, exact_.cols - 1));
  }

  static bool IsJump(float a, float b) {
    return std::abs(a - b) > kEdgePart * std::min(a, b);
  }

  /// Depth at the displaced place if it lies across an edge, else the pixel's
  /// own: smooth surfaces stay unbiased.
  float DisplacedDepth(int v, int u) const {
    const float own = exact_(v, u);
    const float other = At(v + static_cast<int>(std::lround(shift_y_(v, u))),
                           u + static_cast<int>(std::lround(shift_x_(v, u))));
    return IsJump(own, other) ? other : own;
  }

  bool IsEdge(int v, int u, float z) const {
    return IsJump(z, At(v, u - 1)) || IsJump(z, At(v, u + 1)) ||
           IsJump(z, At(v - 1, u)) || IsJump(z, At(v + 1, u));
  }

  /// Change of depth per pixel, the smaller of both sides.
  float Slope(float before, float here, float after) const {
    const float a = here - before, b = after - here;
    return std::abs(a) < std::abs(b) ? a : b;
  }

  /// Cosine of the angle between surface normal and viewing ray.
  float Cosine(int v, int u) const {
    const float z = exact_(v, u);
    const float du = Slope(At(v, u - 1), z, At(v, u + 1));
    const float dv = Slope(At(v - 1, u), z, At(v + 1, u));
    const float x = static_cast<float>((u - camera_.cx) / camera_.fx);
    const float y = static_cast<float>((v - camera_.cy) / camera_.fy);
    const Vector3f ray(x, y, 1);
    const Vector3f along_u(z / static_cast<float>(camera_.fx) + x * du, y * du,
                           du);
    const Vector3f along_v(x * dv, z / static_cast<float>(camera_.fy) + y * dv,
                           dv);
    const Vector3f normal = along_u.cross(along_v);
    return std::abs(normal.dot(ray)) / (normal.norm() * ray.norm());
  }

  bool IsLost(int v, int u, float z) const {
    if (std::abs(blobs_(v, u)) > kBlobSigmas) return true;
    const float chance = HashUnit(u, v, kLoss, seed_);
    if (IsEdge(v, u, z)) return chance < options_.edge_loss;
    const float grazing =
        (min_cosine_ + kGrazingRamp - Cosine(v, u)) / kGrazingRamp;
    const float far =
        (z - static_cast<float>(options_.max_depth) + kRangeRamp) / kRangeRamp;
    return chance < std::max(grazing, far > 0 ? 0.5f * far * far : 0.0f);
  }

  /// Axial noise, then disparity steps; together they have the variance of the
  /// model.
  float Measure(int v, int u, float z) const {
    const auto step = static_cast<float>(options_.disparity_step_px);
    const auto fb = static_cast<float>(options_.focal_times_baseline);
    const float depth_step = z * z / fb * step;
    const float sigma = camera_.noise.Sigma(z);
    const float variance =
        std::max(0.0f, sigma * sigma - depth_step * depth_step / 12);
    const float noisy = z + std::sqrt(variance) * axial_(v, u);
    if (noisy <= 0) return 0;
    return fb / (std::max(1.0f, std::round(fb / (noisy * step))) * step);
  }

  /// Pixels that the projector, right of the camera, does not light: going from
  /// right to left, its own column must keep decreasing.
  std::vector<bool> ProjectorShadow(int v) const {
    const double baseline = options_.focal_times_baseline / 575.8;
    const auto disparity = static_cast<float>(camera_.fx * baseline);
    std::vector<bool> shadow(exact_.cols, false);
    float nearest = 1e9f;
    for (int u = exact_.cols - 1; u >= 0; --u) {
      const float z = exact_(v, u);
      if (z <= 0) continue;
      const float column = static_cast<float>(u) - disparity / z;
      shadow[u] = column > nearest + 1;
      nearest = std::min(nearest, column);
    }
    return shadow;
  }

  const cv::Mat_<float>& exact_;
  const PinholeCamera& camera_;
  std::uint32_t seed_;
  const KinectNoiseOptions& options_;
  cv::Mat_<float> axial_, shift_x_, shift_y_, blobs_;
  float min_cosine_;
};

}  // namespace

cv::Mat_<float> CorrelatedNoise(const cv::Size& size, double correlation_px,
                                std::uint32_t seed) {
  cv::RNG random(seed + 0x9e3779b97f4a7c15ull);
  cv::Mat_<float> noise(size);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  if (correlation_px < 0.3) return noise;
  const int radius = static_cast<int>(std::ceil(3 * correlation_px));
  const cv::Mat_<float> kernel =
      cv::getGaussianKernel(2 * radius + 1, correlation_px, CV_32F);
  cv::sepFilter2D(noise, noise, CV_32F, kernel, kernel, cv::Point(-1, -1), 0,
                  cv::BORDER_REFLECT_101);
  // The blur divides the deviation by the kernel's squared length.
  return noise / kernel.dot(kernel);
}

cv::Mat ApplyKinectNoise(const cv::Mat& exact_depth,
                         const PinholeCamera& camera, std::uint32_t seed,
                         const KinectNoiseOptions& options) {
  if (exact_depth.type() != CV_32FC1 ||
      exact_depth.size() != cv::Size(camera.width, camera.height)) {
    throw InputError("exact depth: expected 32FC1 of the camera's size");
  }
  const cv::Mat_<float> exact = exact_depth;
  const NoiseModel model(exact, camera, seed, options);
  cv::Mat_<float> measured(exact.size());
  tbb::parallel_for(0, exact.rows,
                    [&](int v) { model.MeasureRow(v, measured[v]); });
  return measured;
}

}  // namespace splitfusion
