#include "splitfusion/lib/render/rasterizer.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "support/sample_depth.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

Raster Render(const TriangleMesh& mesh, bool cull = true) {
  Raster raster;
  raster.Clear(SmallCamera());
  RasterizeTriangles(mesh.vertices, mesh.triangles, SmallCamera(), cull, 0,
                     &raster);
  return raster;
}

/// A plate of 2 x 2 m around the optical axis, tilted, that fills the image.
TriangleMesh TiltedPlate() {
  return SheetMesh(3, 3, 0.5, [](double x, double y) {
    return Eigen::Vector3d(x - 1.5, y - 1.5, 1.5 + 0.3 * (x - 1.5));
  });
}

bool SameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(Rasterizer, DepthIsThatOfThePlane) {
  const Raster raster = Render(TiltedPlate());
  // z = 1.5 + 0.3 x.
  const cv::Mat_<float> exact = PlaneDepth(SmallCamera(), {-0.3, 0, 1}, 1.5);
  EXPECT_LT(cv::norm(raster.depth, exact, cv::NORM_INF), 1e-5);
}

TEST(Rasterizer, WeightsArePerspectiveCorrect) {
  const TriangleMesh mesh = TiltedPlate();
  const Raster raster = Render(mesh);
  for (int v = 0; v < 120; v += 7) {
    for (int u = 0; u < 160; u += 5) {
      const Eigen::Vector3i& t = mesh.triangles[raster.triangle(v, u)];
      const cv::Vec3f& w = raster.barycentric(v, u);
      EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-5);
      const Eigen::Vector3f p = w[0] * mesh.vertices[t[0]] +
                                w[1] * mesh.vertices[t[1]] +
                                w[2] * mesh.vertices[t[2]];
      const Eigen::Vector3f ray = SmallCamera().BackProject<float>(
          static_cast<float>(u), static_cast<float>(v), raster.depth(v, u));
      EXPECT_LT((p - ray).norm(), 1e-5);
    }
  }
}

TEST(Rasterizer, SharedEdgesLeaveNoHole) {
  const Raster raster = Render(TiltedPlate());
  EXPECT_EQ(cv::countNonZero(raster.depth > 0), 160 * 120);
}

TEST(Rasterizer, NearerMeshesHideFartherOnesInAnyOrder) {
  const TriangleMesh wall = TiltedPlate();
  TriangleMesh square = PlateMesh(0.2, 0.2, 0.1, 1);
  const auto render = [&](bool wall_first) {
    Raster raster;
    raster.Clear(SmallCamera());
    for (const bool is_wall : {wall_first, !wall_first}) {
      const TriangleMesh& mesh = is_wall ? wall : square;
      RasterizeTriangles(mesh.vertices, mesh.triangles, SmallCamera(), true,
                         is_wall ? 1000 : 0, &raster);
    }
    return raster;
  };
  const Raster a = render(true), b = render(false);
  EXPECT_TRUE(SameBytes(a.depth, b.depth));
  EXPECT_TRUE(SameBytes(a.triangle, b.triangle));
  // The square is 0.2 m of 130 and 131 pixels, from the principal point on.
  EXPECT_LT(a.triangle(70, 90), 1000);
  EXPECT_NEAR(a.depth(70, 90), 1, 1e-5);
  EXPECT_GE(a.triangle(70, 110), 1000);
  EXPECT_NEAR(cv::countNonZero(a.triangle < 1000), 26 * 26.2, 26);
}

TEST(Rasterizer, BackFacesAreCulledOnRequest) {
  TriangleMesh mesh = TiltedPlate();
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(cv::countNonZero(Render(mesh, true).depth), 0);
  EXPECT_EQ(cv::countNonZero(Render(mesh, false).depth), 160 * 120);
  EXPECT_EQ(cv::countNonZero(Render(mesh, true).triangle + 1), 0);
}

TEST(Rasterizer, WhatCannotBeDrawnIsLeftOut) {
  TriangleMesh mesh;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float huge = std::numeric_limits<float>::max();
  mesh.vertices = {{0, 0, 1},      {0.1f, 0, 1}, {0, 0.1f, 1}, {0, 0, -1},
                   {0, 0, 0.001f}, {nan, 0, 1},  {0, 0, nan},  {huge, 0, 1}};
  mesh.triangles = {{0, 1, 3}, {0, 1, 4}, {0, 1, 5},
                    {0, 1, 6}, {0, 0, 1}, {0, 1, 7}};
  EXPECT_EQ(cv::countNonZero(Render(mesh, false).depth), 0);
  const TriangleMesh nothing;
  EXPECT_EQ(cv::countNonZero(Render(nothing).depth), 0);
}

TEST(Rasterizer, ResultDoesNotDependOnThreads) {
  // A crumpled sheet of small triangles, folded over itself.
  const TriangleMesh mesh = SheetMesh(1.2, 0.9, 0.01, [](double x, double y) {
    return Eigen::Vector3d(x - 0.6 + 0.05 * std::sin(40 * y), y - 0.45,
                           1 + 0.1 * std::sin(30 * x) * std::cos(20 * y));
  });
  const auto render = [&](int threads) {
    const tbb::global_control control(
        tbb::global_control::max_allowed_parallelism, threads);
    return Render(mesh, false);
  };
  const Raster one = render(1), two = render(2);
  EXPECT_GT(cv::countNonZero(one.depth), 10000);
  EXPECT_TRUE(SameBytes(one.depth, two.depth));
  EXPECT_TRUE(SameBytes(one.triangle, two.triangle));
}

}  // namespace
}  // namespace splitfusion
