#include "splitfusion/lib/geometry/stretched_area.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

/// A strip of eight triangles with legs of `leg` metres.
TriangleMesh Strip(float leg) {
  TriangleMesh mesh;
  for (int i = 0; i < 10; ++i) {
    mesh.vertices.emplace_back(leg * static_cast<float>(i / 2),
                               leg * static_cast<float>(i % 2), 1);
    if (i >= 2) mesh.triangles.emplace_back(i - 2, i - 1, i);
  }
  return mesh;
}

TEST(CutStretched, TakesOutWhatSpansAGap) {
  const TriangleMesh canonical = Strip(0.005f);
  const double length = StretchedFrom(canonical);
  EXPECT_EQ(length, kStretchedEdge);
  TriangleMesh mesh = canonical;
  StretchedArea area = CutStretched(length, &mesh);
  EXPECT_EQ(mesh.triangles, canonical.triangles);
  EXPECT_NEAR(area.area, 4 * 2.5e-5, 1e-9);
  EXPECT_EQ(area.triangles, 0);
  EXPECT_EQ(area.Share(), 0);
  EXPECT_NEAR(area.longest_edge, 0.00707, 1e-5);
  // The last two vertices move away by 10 cm: two triangles hold them.
  mesh.vertices[8].x() += 0.1f;
  mesh.vertices[9].x() += 0.1f;
  area = CutStretched(length, &mesh);
  EXPECT_EQ(area.triangles, 2);
  EXPECT_NEAR(area.Share(), 5.25e-4 / (5.25e-4 + 3 * 2.5e-5), 1e-4);
  EXPECT_NEAR(area.longest_edge, 0.1051, 1e-4);
  ASSERT_EQ(mesh.triangles.size(), 6u);
  EXPECT_EQ(mesh.triangles.back(), canonical.triangles[5]);
  EXPECT_EQ(mesh.vertices.size(), 10u);
}

TEST(CutStretched, CoarseMeshesAreNotStretched) {
  TriangleMesh mesh = Strip(0.04f);
  EXPECT_NEAR(StretchedFrom(mesh), 0.1131, 1e-4);
  EXPECT_EQ(CutStretched(StretchedFrom(mesh), &mesh).triangles, 0);
  EXPECT_EQ(mesh.triangles.size(), 8u);
}

TEST(CutStretched, NothingHasNoShare) {
  TriangleMesh nothing;
  EXPECT_EQ(CutStretched(1, &nothing).Share(), 0);
}

TEST(StretchedArea, AddsUp) {
  StretchedArea sum = {3, 1, 2, 0.1};
  sum += {1, 1, 5, 0.05};
  EXPECT_EQ(sum.Share(), 0.5);
  EXPECT_EQ(sum.triangles, 7);
  EXPECT_EQ(sum.longest_edge, 0.1);
}

}  // namespace
}  // namespace splitfusion
