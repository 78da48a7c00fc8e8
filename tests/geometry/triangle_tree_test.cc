#include "splitfusion/lib/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace splitfusion {
namespace {

/// Random triangles of about 0.2 m in a cube of 1 m.
struct Soup {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

Soup RandomSoup(int triangles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(0, 1);
  std::uniform_real_distribution<float> side(-0.1f, 0.1f);
  Soup soup;
  for (int i = 0; i < triangles; ++i) {
    const Eigen::Vector3f center(place(random), place(random), place(random));
    for (int k = 0; k < 3; ++k) {
      soup.vertices.push_back(
          center + Eigen::Vector3f(side(random), side(random), side(random)));
    }
    soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return soup;
}

/// Distance to a triangle by looking at a fine grid of its points; never too
/// small, too large by half the grid's step at most.
float SampledDistance(const Eigen::Vector3f& p, const Soup& soup, int t) {
  const Eigen::Vector3f& a = soup.vertices[3 * t];
  const Eigen::Vector3f ab = soup.vertices[3 * t + 1] - a;
  const Eigen::Vector3f ac = soup.vertices[3 * t + 2] - a;
  const int steps = 40;
  float best = 1e9f;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const Eigen::Vector3f q = a + static_cast<float>(i) / steps * ab +
                                static_cast<float>(j) / steps * ac;
      best = std::min(best, (p - q).norm());
    }
  }
  return best;
}

TEST(TriangleTree, AgreesWithExhaustiveSearch) {
  const Soup soup = RandomSoup(60);
  const TriangleTree tree(soup.vertices, soup.triangles);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-0.2f, 1.2f);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3f p(place(random), place(random), place(random));
    float expected = 1e9f;
    for (int t = 0; t < 60; ++t) {
      expected = std::min(expected, SampledDistance(p, soup, t));
    }
    const SurfacePoint found = tree.Closest(p, 10);
    EXPECT_LE(found.distance, expected + 1e-6f);
    EXPECT_GT(found.distance, expected - 0.005f);
    // The weights give the point that is said to be so far away.
    const Eigen::Vector3i& t = soup.triangles[found.triangle];
    Eigen::Vector3f q = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) q += found.barycentric[k] * soup.vertices[t[k]];
    EXPECT_NEAR((p - q).norm(), found.distance, 1e-5);
    EXPECT_NEAR(found.barycentric.sum(), 1, 1e-5);
    EXPECT_GE(found.barycentric.minCoeff(), 0);
  }
}

TEST(TriangleTree, KnowsTheRegionsOfATriangle) {
  const TriangleTree tree({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const auto distance = [&](float x, float y, float z) {
    return tree.Closest({x, y, z}, 10).distance;
  };
  EXPECT_NEAR(distance(0.2f, 0.3f, -0.5f), 0.5, 1e-6);  // Inside.
  EXPECT_NEAR(distance(-3, -4, 0), 5, 1e-6);            // Corners.
  EXPECT_NEAR(distance(2, 0, 0), 1, 1e-6);
  EXPECT_NEAR(distance(0, 3, 0), 2, 1e-6);
  EXPECT_NEAR(distance(0.5f, -0.25f, 0), 0.25, 1e-6);  // Edges.
  EXPECT_NEAR(distance(-0.25f, 0.5f, 0), 0.25, 1e-6);
  EXPECT_NEAR(distance(1, 1, 0), std::sqrt(0.5), 1e-6);
}

TEST(TriangleTree, FindsNothingOutOfReach) {
  const TriangleTree tree({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(tree.Closest({0, 0, 1}, 0.9f).triangle, -1);
  EXPECT_EQ(tree.Closest({0, 0, 1}, 1.1f).triangle, 0);
  EXPECT_EQ(TriangleTree({}, {}).Closest({0, 0, 0}, 9).triangle, -1);
}

TEST(TriangleTree, DegenerateTrianglesArePoints) {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < 100; ++i) {
    points.push_back({0, 0, i % 10 == 0 ? 5.0f : static_cast<float>(i)});
    triangles.emplace_back(i, i, i);
  }
  const TriangleTree tree(points, triangles);
  const SurfacePoint found = tree.Closest({0, 0.5f, 33}, 10);
  EXPECT_EQ(found.triangle, 33);
  EXPECT_NEAR(found.distance, 0.5, 1e-6);
  EXPECT_TRUE(found.barycentric.allFinite());
}

TEST(TriangleTree, TrianglesWithTwoEqualCornersAreSegments) {
  const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {2, 0, 0}};
  for (const Eigen::Vector3i& t :
       {Eigen::Vector3i(0, 0, 1), Eigen::Vector3i(0, 1, 0),
        Eigen::Vector3i(1, 0, 0), Eigen::Vector3i(1, 1, 0)}) {
    const TriangleTree tree(points, {t});
    for (const float x : {0.0f, 0.5f, 1.0f, 2.0f}) {
      const SurfacePoint found = tree.Closest({x, 0, 1}, 10);
      EXPECT_NEAR(found.distance, 1, 1e-6) << t.transpose() << " at " << x;
      EXPECT_TRUE(found.barycentric.allFinite());
    }
    EXPECT_NEAR(tree.Closest({3, 0, 0}, 10).distance, 1, 1e-6);
  }
}

TEST(TriangleTree, NeedlesDoNotHideTheirNeighbours) {
  // Corners on a line that rounding bends: a random search for weights that
  // are not finite.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0, 1);
  const Eigen::Vector3f step(0.3f, 0.1f, 0.7f);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f a(place(random), place(random), place(random));
    const TriangleTree tree(
        {a, a + place(random) * step, a + place(random) * step}, {{0, 1, 2}});
    const Eigen::Vector3f p(place(random), place(random), place(random));
    const SurfacePoint found = tree.Closest(p, 10);
    if (found.triangle < 0) continue;
    EXPECT_TRUE(std::isfinite(found.distance));
    EXPECT_LE(found.distance, (p - a).norm() + 1e-4f);
  }
}

}  // namespace
}  // namespace splitfusion
