#include "splitfusion/lib/geometry/point_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/window_planes.h"
namespace splitfusion {
namespace {

constexpr PinholeCamera kMapCamera = {64, 48, 260, 260, 31.5, 23.5};

/// Depth of the plane n . X = d.
cv::Mat_<float> PlaneDepth(const Eigen::Vector3d& n, double d) {
  cv::Mat_<float> depth(kMapCamera.height, kMapCamera.width);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = kMapCamera.BackProject<double>(u, v, 1);
      depth(v, u) = static_cast<float>(d / n.dot(ray));
    }
  }
  return depth;
}

Eigen::Vector3d ToEigen(const cv::Vec3f& v) { return {v[0], v[1], v[2]}; }

TEST(ComputePointMap, PlaneHasItsNormalEverywhere) {
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, -0.4, 1).normalized();
  const PointMap map = ComputePointMap(PlaneDepth(n, 1.2), kMapCamera);
  for (int v = 0; v < kMapCamera.height; ++v) {
    for (int u = 0; u < kMapCamera.width; ++u) {
      EXPECT_NEAR(n.dot(ToEigen(map.points(v, u))), 1.2, 1e-5);
      // At the very corners less than a third of the window is there.
      if (u % (kMapCamera.width - 1) == 0 && v % (kMapCamera.height - 1) == 0) {
        continue;
      }
      // Towards the camera.
      EXPECT_TRUE(ToEigen(map.normals(v, u)).isApprox(-n, 2e-3));
    }
  }
}

TEST(ComputePointMap, MissingDepthHasNeitherPointNorNormal) {
  cv::Mat_<float> depth = PlaneDepth({0, 0, 1}, 1);
  depth(20, 30) = 0;
  const PointMap map = ComputePointMap(depth, kMapCamera);
  EXPECT_EQ(map.points(20, 30), cv::Vec3f(0, 0, 0));
  EXPECT_EQ(map.normals(20, 30), cv::Vec3f(0, 0, 0));
  EXPECT_NEAR(map.normals(20, 31)[2], -1, 1e-5);
}

TEST(ComputePointMap, NormalsDoNotMixTheTwoSidesOfAStep) {
  cv::Mat_<float> depth = PlaneDepth({0, 0, 1}, 1);
  depth.colRange(32, 64).setTo(1.5f);
  const PointMap map = ComputePointMap(depth, kMapCamera);
  for (const int u : {30, 31, 32, 33}) {
    EXPECT_NEAR(map.normals(24, u)[2], -1, 1e-5) << u;
  }
}

TEST(ComputePointMap, SpecksHaveNoNormal) {
  cv::Mat_<float> depth(kMapCamera.height, kMapCamera.width, 0.0f);
  depth(10, 10) = 1;
  depth(10, 11) = 1;
  EXPECT_EQ(ComputePointMap(depth, kMapCamera).normals(10, 10),
            cv::Vec3f(0, 0, 0));
}

TEST(ComputePointMap, RejectsForeignImagesAndOptions) {
  EXPECT_THROW(ComputePointMap(cv::Mat(48, 64, CV_16UC1), kMapCamera),
               InputError);
  EXPECT_THROW(ComputePointMap(cv::Mat(47, 64, CV_32FC1), kMapCamera),
               InputError);
  PointMapOptions options;
  options.radius = 0;
  EXPECT_THROW(ComputePointMap(PlaneDepth({0, 0, 1}, 1), kMapCamera, options),
               InputError);
}

TEST(DepthNoise, GrowsWithDistance) {
  const DepthNoise noise;
  EXPECT_NEAR(noise.Sigma(0.4), 0.0012, 1e-9);
  EXPECT_LT(noise.Sigma(1.0), noise.Sigma(2.0));
  EXPECT_LT(noise.Sigma(2.0f), noise.Sigma(4.0f));
}

TEST(SumWindows, CountsThePixelsAtTheCentresDepth) {
  // Depth 1 + 0.01 column, in rows of 20 pixels; gate 0.015: one column either
  // side, of three rows.
  constexpr int kRadius = 2, kStride = 20;
  std::vector<float> depth(kStride * 5), inverse(kStride * 5);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const std::size_t row = i / kStride;
    depth[i] = row >= 1 && row <= 3 ? 1 + 0.01f * (i % kStride) : 0.0f;
    inverse[i] = 1 / depth[i];
  }
  std::vector<float> gate(kWindowPixels, 0.015f);
  gate[3] = 0.005f;  // Only its own column.
  WindowSums sums;
  SumWindows({depth.data(), inverse.data(), kStride, kRadius, 0.5f, 0.25f},
             &depth[2 * kStride + kRadius], gate.data(), &sums);
  for (int i = 0; i < kWindowPixels; ++i) {
    const int columns = i == 3 ? 1 : 3;
    const float center = 1 / (1 + 0.01f * (i + kRadius));
    EXPECT_EQ(sums.count[i], 3 * columns);
    EXPECT_EQ(sums.x[i], 0);
    EXPECT_EQ(sums.y[i], 0);
    EXPECT_EQ(sums.xx[i], i == 3 ? 0 : 6 * 0.25f);
    EXPECT_EQ(sums.yy[i], 2 * columns * 0.0625f);
    EXPECT_EQ(sums.xy[i], 0);
    EXPECT_NEAR(sums.z[i], 3 * columns * center, 1e-3);
    EXPECT_NEAR(sums.yz[i], 0, 1e-6);
    EXPECT_TRUE(i == 3 ? sums.xz[i] == 0 : sums.xz[i] < 0);
  }
}

TEST(PointMap, KnowsHowFarNormalsAreOff) {
  const PinholeCamera camera{160, 120, 260, 260, 80, 60};
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 1);
  for (const float z : {1.0f, 3.0f}) {
    cv::Mat_<float> depth(camera.height, camera.width);
    for (float& d : depth) d = z + camera.noise.Sigma(z) * noise(random);
    const PointMap map = ComputePointMap(depth, camera);
    double sum = 0;
    int count = 0;
    for (int v = 10; v < 110; ++v) {
      for (int u = 10; u < 150; ++u, ++count) {
        sum += std::pow(map.normals(v, u)[0] / map.normals(v, u)[2], 2);
      }
    }
    const double sigma = std::sqrt(sum / count);
    EXPECT_NEAR(map.NormalSigma(z, camera.fx), sigma, 0.15 * sigma) << z;
  }
  EXPECT_EQ(PointMap().NormalSigma(2, 500), 0);  // Exact normals.
}

}  // namespace
}  // namespace splitfusion
