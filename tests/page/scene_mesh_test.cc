#include "splitfusion/lib/page/scene_mesh.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "splitfusion/lib/page/packed_arrays.h"

namespace splitfusion {
namespace {

/// A square of 1 m in steps of 1 cm, but for one vertex that no triangle has.
TriangleMesh Square() {
  constexpr int kSide = 101;
  TriangleMesh mesh;
  mesh.vertices.emplace_back(9, 9, 9);
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      mesh.vertices.emplace_back(0.01f * u, 0.01f * v, 1);
      if (u + 1 == kSide || v + 1 == kSide) continue;
      const int i = 1 + v * kSide + u;
      mesh.triangles.emplace_back(i, i + 1, i + kSide);
      mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
    }
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.colors.push_back({static_cast<std::uint8_t>(i % 251), 0, 0});
  }
  return mesh;
}

double Area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]];
    const Eigen::Vector3f b = mesh.vertices[t[1]] - a;
    const Eigen::Vector3f c = mesh.vertices[t[2]] - a;
    area += 0.5 * b.cross(c).norm();
  }
  return area;
}

TEST(SceneMesh, KeepsVerticesOfTheMeshAndItsShape) {
  const TriangleMesh mesh = Square();
  const SmallerMesh smaller = SimplifiedMesh(mesh, 500);
  EXPECT_LE(smaller.mesh.triangles.size(), 1000u);
  EXPECT_LT(smaller.mesh.vertices.size(), 900u);
  EXPECT_NEAR(Area(smaller.mesh), 1, 1e-3);
  ASSERT_EQ(smaller.source.size(), smaller.mesh.vertices.size());
  for (std::size_t i = 0; i < smaller.source.size(); ++i) {
    EXPECT_EQ(smaller.mesh.vertices[i], mesh.vertices[smaller.source[i]]);
    EXPECT_EQ(smaller.mesh.colors[i], mesh.colors[smaller.source[i]]);
  }
}

TEST(SceneMesh, ThatIsSmallEnoughLosesOnlyWhatNoTriangleNeeds) {
  const TriangleMesh mesh = Square();
  const SmallerMesh smaller = SimplifiedMesh(mesh, 20000);
  EXPECT_EQ(smaller.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(smaller.mesh.vertices.size(), mesh.vertices.size() - 1);
  EXPECT_EQ(
      std::set<int>(smaller.source.begin(), smaller.source.end()).count(0), 0u);
}

TEST(SceneMesh, OfNothingIsNothing) {
  EXPECT_TRUE(SimplifiedMesh(TriangleMesh(), 10).mesh.empty());
}

TEST(PackedArrays, HaveAsManyPlanesAsTheLargestStepNeeds) {
  PackedArrays arrays;
  EXPECT_EQ(arrays.Add({0, 0, 0}, 1).dump(),
            R"({"offset":0,"count":3,"planes":0,"lag":1})");
  // Steps of a hundred: one byte; of a thousand: two.
  EXPECT_EQ(arrays.Add({100, 7, 200, 7}, 2).dump(),
            R"({"offset":0,"count":4,"planes":1,"lag":2})");
  EXPECT_EQ(arrays.Add({1000, 2000, -3000}, 1).dump(),
            R"({"offset":4,"count":3,"planes":2,"lag":1})");
  EXPECT_EQ(arrays.Add({INT32_MIN, INT32_MAX}, 1)["planes"], 4);
  EXPECT_FALSE(arrays.Text().empty());
}

}  // namespace
}  // namespace splitfusion
