#include "splitfusion/lib/geometry/mesh_pieces.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

/// Appends a square of side `side` at `x`, in two triangles.
void AddSquare(float x, float side, std::uint8_t red, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    mesh->vertices.emplace_back(x + side * static_cast<float>(u),
                                side * static_cast<float>(v), 0.f);
    mesh->normals.emplace_back(0, 0, 1);
    mesh->colors.push_back({red, 0, 0});
  }
  mesh->triangles.emplace_back(first, first + 1, first + 2);
  mesh->triangles.emplace_back(first, first + 2, first + 3);
}

TEST(WithoutSmallPieces, KeepsOrderAndAttributesOfLargeOnes) {
  TriangleMesh mesh;
  AddSquare(0, 0.05f, 1, &mesh);  // 0.0025 m^2.
  AddSquare(1, 0.2f, 2, &mesh);
  mesh.vertices.emplace_back(9, 9, 9);  // Of no triangle.
  mesh.normals.emplace_back(0, 0, 1);
  mesh.colors.push_back({9, 9, 9});
  AddSquare(2, 0.3f, 3, &mesh);
  const TriangleMesh kept = WithoutSmallPieces(mesh, 0.01);
  ASSERT_EQ(kept.vertices.size(), 8u);
  EXPECT_EQ(kept.vertices[0], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(kept.colors[7][0], 3);
  EXPECT_EQ(kept.normals.size(), 8u);
  ASSERT_EQ(kept.triangles.size(), 4u);
  EXPECT_EQ(kept.triangles[2], Eigen::Vector3i(4, 5, 6));
  EXPECT_EQ(WithoutSmallPieces(mesh, 0).triangles.size(), 6u);
}

TEST(WithoutSmallPieces, NeverLeavesNothing) {
  TriangleMesh mesh;
  AddSquare(0, 0.05f, 1, &mesh);
  AddSquare(1, 0.04f, 2, &mesh);
  const TriangleMesh kept = WithoutSmallPieces(mesh, 1);
  ASSERT_EQ(kept.vertices.size(), 4u);
  EXPECT_EQ(kept.colors[0][0], 1);
  EXPECT_TRUE(WithoutSmallPieces({}, 1).empty());
}

}  // namespace
}  // namespace splitfusion
