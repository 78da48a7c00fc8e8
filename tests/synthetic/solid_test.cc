#include "splitfusion/lib/synthetic/solid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/lib/synthetic/room.h"
#include "synthetic/mesh_checks.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

TexturedMesh Surface(const Solid& solid, float cell) {
  TexturedMesh surface;
  AppendSolid(solid, cell, &surface);
  return surface;
}

TEST(Solid, SurfaceEnclosesTheSolidsVolume) {
  Solid solid;
  solid.half_size = {0.2f, 0.2f, 0.5f};
  solid.center = {1, 2, 3};
  solid.yaw = 0.7f;
  const double box = 8 * 0.2 * 0.2 * 0.5;
  EXPECT_NEAR(SignedVolume(Surface(solid, 0.1f).mesh), box, 1e-5);
  solid.shape = SolidShape::kCylinder;
  EXPECT_NEAR(SignedVolume(Surface(solid, 0.02f).mesh), box * M_PI / 4, 1e-3);
  solid.shape = SolidShape::kSphere;
  EXPECT_NEAR(SignedVolume(Surface(solid, 0.02f).mesh), box * M_PI / 6, 1e-3);
}

TEST(Solid, ARoomIsSeenFromInside) {
  Solid solid;
  solid.inside_out = true;
  EXPECT_NEAR(SignedVolume(Surface(solid, 0.5f).mesh), -1, 1e-5);
}

TEST(Solid, CellsAreNoLargerThanAsked) {
  Solid solid;
  solid.half_size = {1, 0.3f, 0.01f};
  const TexturedMesh surface = Surface(solid, 0.1f);
  for (const Eigen::Vector3i& t : surface.mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vector3f edge =
          surface.mesh.vertices[t[k]] - surface.mesh.vertices[t[(k + 1) % 3]];
      EXPECT_LE(edge.norm(), 0.1f * std::sqrt(2.0f) + 1e-5f);
    }
  }
}

TEST(Solid, ContainsTurnsWithTheSolid) {
  Solid solid;
  solid.half_size = {0.5f, 0.1f, 0.5f};
  EXPECT_TRUE(Contains(solid, {0.4f, 0, 0}));
  EXPECT_FALSE(Contains(solid, {0, 0.4f, 0}));
  solid.yaw = static_cast<float>(M_PI / 2);
  EXPECT_FALSE(Contains(solid, {0.4f, 0, 0}));
  EXPECT_TRUE(Contains(solid, {0, 0.4f, 0}));
}

TEST(Solid, CornersOfTheBoxAreOutsideOfRoundShapes) {
  Solid solid;
  const Vector3f corner(0.45f, 0.45f, 0.0f);
  EXPECT_TRUE(Contains(solid, corner));
  solid.shape = SolidShape::kCylinder;
  EXPECT_FALSE(Contains(solid, corner));
  EXPECT_TRUE(Contains(solid, {0.4f, 0, 0.49f}));
  solid.shape = SolidShape::kSphere;
  EXPECT_FALSE(Contains(solid, {0.4f, 0, 0.49f}));
}

TEST(Room, EveryTriangleHasATextureAndStandsInTheRoom) {
  const Room room = MakeRoom(1);
  const TexturedMesh& surface = room.surface;
  ASSERT_EQ(surface.triangle_materials.size(), surface.mesh.triangles.size());
  ASSERT_EQ(surface.triangle_instances.size(), surface.mesh.triangles.size());
  for (const auto material : surface.triangle_materials) {
    ASSERT_LT(material, surface.materials.size());
  }
  Solid walls = room.solids.front();
  walls.half_size += Vector3f::Constant(1e-3f);
  for (const Vector3f& vertex : surface.mesh.vertices) {
    ASSERT_TRUE(Contains(walls, vertex)) << vertex.transpose();
  }
}

/// True if a corner, edge centre or face centre of `a` is within 2 cm of `b`.
bool Touches(const Solid& a, Solid b) {
  b.half_size += Vector3f::Constant(0.02f);
  for (int k = 0; k < 27; ++k) {
    const Vector3f unit(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    if (Contains(b, a.center + unit.cwiseProduct(a.half_size))) return true;
  }
  return false;
}

TEST(Room, FurnitureHangsTogetherFromTheFloorOrAWall) {
  const std::vector<Solid> solids = MakeRoom(1).solids;
  std::vector<bool> held(solids.size(), false);
  for (std::size_t round = 0; round < 4; ++round) {
    for (std::size_t i = 1; i < solids.size(); ++i) {
      const Solid& solid = solids[i];
      held[i] = held[i] || solid.center.z() - solid.half_size.z() < 0.01f ||
                std::abs(solid.center.x()) > 2.1f || solid.center.y() > 1.75f;
      for (std::size_t j = 1; j < solids.size(); ++j) {
        const bool touch =
            Touches(solid, solids[j]) || Touches(solids[j], solid);
        if (touch && held[j]) held[i] = true;
      }
    }
  }
  for (std::size_t i = 1; i < solids.size(); ++i) {
    EXPECT_TRUE(held[i]) << "solid " << i << " at "
                         << solids[i].center.transpose();
  }
}

TEST(Room, OnlyTexturesDependOnTheSeed) {
  const Room a = MakeRoom(1), b = MakeRoom(1), c = MakeRoom(2);
  EXPECT_EQ(a.surface.mesh.vertices, b.surface.mesh.vertices);
  EXPECT_EQ(a.surface.materials[0].seed, b.surface.materials[0].seed);
  EXPECT_NE(a.surface.materials[0].seed, c.surface.materials[0].seed);
}

}  // namespace
}  // namespace splitfusion
