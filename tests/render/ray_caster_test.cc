#include "splitfusion/lib/render/ray_caster.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "support/expect_input_error.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

constexpr double kVoxel = 0.01, kRadius = 0.3;
const Eigen::Vector3d kCenter(0.05, -0.02, 1.1);

/// A sphere fused from one exact depth image.
TsdfVolume SphereVolume(const Rigid3d& camera_from_canonical) {
  TsdfVolume volume({kVoxel, 0.04, 64});
  const DepthObservation observation =
      ObserveAll(SmallCamera(), SphereDepth(SmallCamera(), kCenter, kRadius));
  AllocateBand(observation, camera_from_canonical, &volume);
  IntegrateRigid(observation, camera_from_canonical, &volume);
  return volume;
}

/// z-depth that a camera sees of the volume, 0 = nothing.
cv::Mat_<float> CastDepth(const TsdfVolume& volume, const Rigid3d& motion,
                          const RayCastOptions& options = {}) {
  cv::Mat_<float> depth;
  cv::extractChannel(RayCast(volume, motion, SmallCamera(), options).points,
                     depth, 2);
  return depth;
}

/// Calls visit(v, u, point) for pixels that see the sphere under less than 45
/// degrees.
template <typename Visit>
int ForEachFacingPixel(const Visit& visit) {
  const cv::Mat_<float> depth = SphereDepth(SmallCamera(), kCenter, kRadius);
  int count = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d p =
          SmallCamera().BackProject<double>(u, v, depth(v, u));
      if (!(depth(v, u) > 0) ||
          (kCenter - p).dot(p) < 0.7 * kRadius * p.norm()) {
        continue;
      }
      visit(v, u, p);
      ++count;
    }
  }
  return count;
}

TEST(RayCaster, SphereIsWithinAFractionOfAVoxel) {
  const Rigid3d motion = MakeMotion({0.3, -0.2, 0.1}, {0.5, -0.4, 0.2});
  const ModelMap map =
      RayCast(SphereVolume(motion), motion, SmallCamera(), RayCastOptions());
  double sum = 0, largest = 0;
  int missed = 0;
  const int count =
      ForEachFacingPixel([&](int v, int u, const Eigen::Vector3d& p) {
        if (map.points(v, u)[2] == 0) {
          ++missed;
          return;
        }
        const double error = std::abs(map.points(v, u)[2] - p.z());
        sum += error;
        largest = std::max(largest, error);
        const Eigen::Vector3d normal = (p - kCenter) / kRadius;
        const cv::Vec3f& n = map.normals(v, u);
        // 16 degrees: a pixel is as wide as a voxel, and steps show on slopes.
        EXPECT_GT(normal.dot(Eigen::Vector3d(n[0], n[1], n[2])), 0.96);
        EXPECT_EQ(map.color(v, u), cv::Vec3b(0, 0, 255));
      });
  EXPECT_GT(count, 1500);
  EXPECT_LE(missed, 0.003 * count);
  EXPECT_LT(sum / count, 0.15 * kVoxel);
  EXPECT_LT(largest, 0.7 * kVoxel);
}

TEST(RayCaster, PointsLieOnTheRaysOfTheirPixels) {
  const ModelMap map =
      RayCast(SphereVolume(Rigid3d::Identity()), Rigid3d::Identity(),
              SmallCamera(), RayCastOptions());
  ForEachFacingPixel([&](int v, int u, const Eigen::Vector3d&) {
    const cv::Vec3f& p = map.points(v, u);
    if (p[2] == 0) return;
    const Eigen::Vector2d pixel =
        SmallCamera().Project(Eigen::Vector3d(p[0], p[1], p[2]));
    EXPECT_LT((pixel - Eigen::Vector2d(u, v)).norm(), 1e-3);
  });
}

TEST(RayCaster, SeesTheSurfaceFromElsewhere) {
  const TsdfVolume volume = SphereVolume(Rigid3d::Identity());
  // The camera steps 30 cm aside and turns to the sphere.
  const Rigid3d motion = MakeMotion({0, 0.25, 0}, {-0.3, 0, 0.05});
  const cv::Mat_<float> depth = CastDepth(volume, motion);
  const cv::Mat_<float> exact =
      SphereDepth(SmallCamera(), motion * kCenter, kRadius);
  int seen = 0, off = 0;
  for (int i = 0; i < 160 * 120; ++i) {
    const float z = depth(i / 160, i % 160);
    if (z == 0) continue;
    ++seen;
    off += std::abs(z - exact(i / 160, i % 160)) > 2.5 * kVoxel;
  }
  EXPECT_GT(seen, 1500);
  // The silhouette is a little blurred where it was seen flatly.
  EXPECT_LT(off, 0.01 * seen);
}

TEST(RayCaster, TheBackOfASurfaceIsNoSurface) {
  const TsdfVolume volume = SphereVolume(Rigid3d::Identity());
  // From behind: the camera looks at the sphere's unseen side.
  Rigid3d motion = MakeMotion({0, M_PI, 0}, {0, 0, 0});
  motion.translation() = Eigen::Vector3d(0, 0, 1.2) - motion.linear() * kCenter;
  EXPECT_LT(cv::countNonZero(CastDepth(volume, motion)), 20);
}

TEST(RayCaster, RespectsItsLimits) {
  const TsdfVolume volume = SphereVolume(Rigid3d::Identity());
  const auto pixels = [&](const RayCastOptions& options) {
    return cv::countNonZero(CastDepth(volume, Rigid3d::Identity(), options));
  };
  EXPECT_GT(pixels({0.2, 6, 0.01}), 3000);
  EXPECT_EQ(pixels({0.2, 0.7, 0.01}), 0);
  EXPECT_EQ(pixels({1.5, 6, 0.01}), 0);
  EXPECT_EQ(pixels({0.2, 6, 1.5}), 0);  // Seen once, with weight 1.
  EXPECT_EQ(cv::countNonZero(
                CastDepth(TsdfVolume({kVoxel, 0.04, 64}), Rigid3d::Identity())),
            0);
}

TEST(RayCaster, ResultDoesNotDependOnThreads) {
  const TsdfVolume volume = SphereVolume(Rigid3d::Identity());
  const auto cast = [&](int threads) {
    const tbb::global_control control(
        tbb::global_control::max_allowed_parallelism, threads);
    return CastDepth(volume, Rigid3d::Identity());
  };
  const cv::Mat_<float> one = cast(1), two = cast(2);
  EXPECT_EQ(std::memcmp(one.data, two.data, one.total() * sizeof(float)), 0);
}

TEST(RayCastOptions, RefuseValuesOutOfRange) {
  ExpectInputError(
      [] {
        CheckOptions(RayCastOptions{0, 6, 0.01});
      },
      "min_depth = 0: expected metres > 0");
  ExpectInputError(
      [] {
        CheckOptions(RayCastOptions{1, 1, 0.01});
      },
      "max_depth = 1: expected metres > ray_min_depth");
  ExpectInputError(
      [] {
        CheckOptions(RayCastOptions{1, 2, -1});
      },
      "min_weight = -1: expected >= 0");
}

TEST(RayCaster, DoesNotDependOnTheNumberOfThreads) {
  const TsdfVolume volume = SphereVolume(Rigid3d::Identity());
  const auto cast = [&] {
    return RayCast(volume, Rigid3d::Identity(), SmallCamera(),
                   RayCastOptions());
  };
  const ModelMap parallel = cast();
  const tbb::global_control one_thread(
      tbb::global_control::max_allowed_parallelism, 1);
  const ModelMap serial = cast();
  EXPECT_EQ(cv::norm(parallel.points, serial.points, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(parallel.normals, serial.normals, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(parallel.color, serial.color, cv::NORM_INF), 0);
}

TEST(RayCaster, SeesNothingInAnEmptyVolume) {
  const ModelMap map = RayCast(TsdfVolume(TsdfOptions()), Rigid3d::Identity(),
                               SmallCamera(), RayCastOptions());
  EXPECT_EQ(cv::countNonZero(map.points.reshape(1)), 0);
}

}  // namespace
}  // namespace splitfusion
