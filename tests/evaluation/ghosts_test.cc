#include "splitfusion/lib/evaluation/ghosts.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(CountGhosts, CountsVerticesFarFromTheStaticScene) {
  TriangleMesh scene;
  scene.vertices = {{-1, -1, 2}, {1, -1, 2}, {-1, 1, 2}, {1, 1, 2}};
  scene.triangles = {{0, 1, 2}, {2, 1, 3}};
  TriangleMesh background;
  for (int i = 0; i < 90; ++i) {  // Up to 4.5 cm off.
    background.vertices.emplace_back(0.01f * i, 0, 2 - 0.0005f * i);
  }
  EXPECT_EQ(CountGhosts(background, scene).far, 0);
  for (int i = 0; i < 10; ++i) {  // A patch half a metre in front.
    background.vertices.emplace_back(0.01f * i, 0, 1.5f);
  }
  const Ghosts ghosts = CountGhosts(background, scene);
  EXPECT_EQ(ghosts.far, 10);
  EXPECT_EQ(ghosts.vertices, 100);
  EXPECT_DOUBLE_EQ(ghosts.Share(), 0.1);
  EXPECT_EQ(CountGhosts({}, scene).Share(), 0);
}

}  // namespace
}  // namespace splitfusion
