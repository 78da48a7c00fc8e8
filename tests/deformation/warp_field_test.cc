#include <gtest/gtest.h>

#include "splitfusion/lib/deformation/skinning.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

class WarpFieldTest : public ::testing::Test {
 protected:
  WarpFieldTest() : graph_(CoverWithNodes(mesh_, 0.04)) {}

  const TriangleMesh mesh_ = PlateMesh(0.3, 0.2, 0.01, 1);
  DeformationGraph graph_;
};

TEST_F(WarpFieldTest, PointsFollowEquationTwo) {
  Shake(0.2, /*seed=*/1, &graph_);
  const SkinningIndex index(graph_, 6);
  const WarpField warp(graph_);
  for (std::size_t i = 0; i < mesh_.vertices.size(); i += 11) {
    const Eigen::Vector3f& v = mesh_.vertices[i];
    const Skinning skinning = index.Skin(v);
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    for (int k = 0; k < skinning.count; ++k) {
      const int node = skinning.nodes[k];
      expected += skinning.weights[k] * ApplyNode(graph_.positions[node],
                                                  graph_.motions[node],
                                                  v.cast<double>());
    }
    EXPECT_LT((warp.WarpPoint(skinning, v) - expected.cast<float>()).norm(),
              1e-6);
  }
}

TEST_F(WarpFieldTest, ARigidMotionOfAllNodesIsRigid) {
  const Rigid3d motion = MakeMotion({0.5, -0.8, 0.3}, {0.1, 0.2, 0.3});
  ApplyRigidMotion(motion, &graph_);
  const SkinningIndex index(graph_, 6);
  const WarpField warp(graph_);
  for (const Eigen::Vector3f& v : mesh_.vertices) {
    const Skinning skinning = index.Skin(v);
    EXPECT_LT((warp.WarpPoint(skinning, v) - motion.cast<float>() * v).norm(),
              2e-6);
    const Eigen::Vector3f turned =
        motion.linear().cast<float>() * Eigen::Vector3f(0, 0, -1);
    EXPECT_LT((warp.WarpNormal(skinning, {0, 0, -1}) - turned).norm(), 1e-5);
  }
}

TEST_F(WarpFieldTest, ABendIsFollowedBetweenTheNodes) {
  constexpr double kCurvature = 2;  // Radius 0.5 m.
  MoveNodes([](const Eigen::Vector3d& p) { return Bend(p, 1, kCurvature); },
            &graph_);
  const SkinningIndex index(graph_, 6);
  const WarpField warp(graph_);
  for (const Eigen::Vector3f& v : mesh_.vertices) {
    const Skinning skinning = index.Skin(v);
    const Eigen::Vector3d bent = Bend(v.cast<double>(), 1, kCurvature);
    // Linear blending cuts corners by about (0.04 m)^2 * curvature / 2.
    EXPECT_LT((warp.WarpPoint(skinning, v).cast<double>() - bent).norm(), 2e-3);
    const double angle = kCurvature * v.x();
    const Eigen::Vector3d normal(std::sin(angle), 0, -std::cos(angle));
    EXPECT_GT(warp.WarpNormal(skinning, {0, 0, -1}).cast<double>().dot(normal),
              std::cos(0.06));
  }
}

TEST_F(WarpFieldTest, UnwarpNormalUndoesWarpNormal) {
  Shake(0.1, /*seed=*/2, &graph_);
  const SkinningIndex index(graph_, 6);
  const WarpField warp(graph_);
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3f, -0.4f, -1).normalized();
  for (const Eigen::Vector3f& v : mesh_.vertices) {
    const Skinning skinning = index.Skin(v);
    const Eigen::Vector3f warped = warp.WarpNormal(skinning, normal);
    EXPECT_NEAR(warped.norm(), 1, 1e-5);
    // Exact for one rotation; a blend of rotations up to their spread.
    EXPECT_GT(warp.UnwarpNormal(skinning, warped).dot(normal), 0.9999f);
  }
}

TEST_F(WarpFieldTest, ABlendedMotionAgreesWithTheFieldAtItsPoint) {
  Shake(0.2, /*seed=*/4, &graph_);
  const SkinningIndex index(graph_, 6);
  const WarpField warp(graph_);
  for (std::size_t i = 0; i < mesh_.vertices.size(); i += 5) {
    const Eigen::Vector3f& v = mesh_.vertices[i];
    const Skinning skinning = index.Skin(v);
    const NodeMotion motion = warp.BlendMotion(skinning, v);
    const Eigen::Vector3d g = v.cast<double>();
    EXPECT_LT(
        (ApplyNode(g, motion, g).cast<float>() - warp.WarpPoint(skinning, v))
            .norm(),
        1e-6);
    EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-9);
  }
}

TEST_F(WarpFieldTest, IsASnapshot) {
  const WarpField warp(graph_);
  const SkinningIndex index(graph_, 6);
  Shake(0.2, /*seed=*/6, &graph_);
  const Eigen::Vector3f p(0.1f, 0.1f, 1);
  EXPECT_LT((warp.WarpPoint(index.Skin(p), p) - p).norm(), 1e-6);
}

}  // namespace
}  // namespace splitfusion
