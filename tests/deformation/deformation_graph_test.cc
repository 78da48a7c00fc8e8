#include "splitfusion/lib/deformation/deformation_graph.h"

#include <gtest/gtest.h>

#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

DeformationGraph ThreeNodes() {
  DeformationGraph graph;
  graph.positions = {{0, 0, 1}, {0.1, 0, 1}, {0, 0.2, 1.3}};
  graph.motions.resize(3);
  graph.node_spacing = 0.1;
  Shake(0.5, /*seed=*/3, &graph);
  return graph;
}

double Difference(const Rigid3d& a, const Rigid3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(DeformationGraph, NodeMovesPointsByEquationOne) {
  NodeMotion motion;
  motion.rotation = ExpSo3({0, 0, M_PI / 2});
  motion.translation = {10, 20, 30};
  // p - g = (1, 0, 0) turns to (0, 1, 0).
  const Eigen::Vector3d moved = ApplyNode({1, 2, 3}, motion, {2, 2, 3});
  EXPECT_LT((moved - Eigen::Vector3d(11, 23, 33)).norm(), 1e-12);
}

TEST(DeformationGraph, RigidGraphCarriesPointsByItsMotion) {
  const Rigid3d motion = MakeMotion({0.3, -0.2, 0.1}, {1, 2, 3});
  const DeformationGraph graph = MakeRigidGraph(motion);
  ASSERT_TRUE(graph.rigid());
  EXPECT_TRUE(graph.neighbors.at(0).empty());
  const Eigen::Vector3d p(0.4, -0.5, 2);
  EXPECT_LT(
      (ApplyNode(graph.positions[0], graph.motions[0], p) - motion * p).norm(),
      1e-12);
  EXPECT_LT(Difference(MeanRigidMotion(graph), motion), 1e-12);
}

TEST(DeformationGraph, RigidMotionCarriesWhatEveryNodeCarries) {
  const DeformationGraph before = ThreeNodes();
  const Rigid3d motion = MakeMotion({-0.4, 0.9, 0.2}, {0.5, -1, 2});
  DeformationGraph after = before;
  ApplyRigidMotion(motion, &after);
  const Eigen::Vector3d p(0.05, 0.03, 1.1);
  for (int i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d& g = before.positions[i];
    EXPECT_EQ(after.positions[i], g);  // Rest positions stay.
    EXPECT_LT((ApplyNode(g, after.motions[i], p) -
               motion * ApplyNode(g, before.motions[i], p))
                  .norm(),
              1e-12);
  }
}

TEST(DeformationGraph, MeanRigidMotionIsTheCommonMotion) {
  DeformationGraph graph = ThreeNodes();
  for (NodeMotion& motion : graph.motions) motion = NodeMotion();
  const Rigid3d motion = MakeMotion({1.2, -0.4, 0.3}, {0.1, 0.2, -0.3});
  ApplyRigidMotion(motion, &graph);
  EXPECT_LT(Difference(MeanRigidMotion(graph), motion), 1e-12);
}

TEST(DeformationGraph, MeanRigidMotionTurnsWithTheGraph) {
  DeformationGraph graph = ThreeNodes();
  const Rigid3d mean = MeanRigidMotion(graph);
  const Rigid3d motion = MakeMotion({0.7, 0.1, -0.6}, {3, -2, 1});
  ApplyRigidMotion(motion, &graph);
  EXPECT_LT(Difference(MeanRigidMotion(graph), motion * mean), 1e-9);
}

TEST(DeformationGraph, MeanRigidMotionOfAStretchStaysInTheMiddle) {
  DeformationGraph graph;
  graph.positions = {{-0.5, 0, 1}, {0.5, 0, 1}};
  graph.motions.resize(2);
  graph.node_spacing = 0.1;
  graph.motions[0].translation = {-0.1, 0.2, 0.4};
  graph.motions[1].translation = {0.1, 0.2, 0.4};
  const Rigid3d mean = MeanRigidMotion(graph);
  EXPECT_LT(RotationAngle(mean.linear()), 1e-9);
  EXPECT_LT((mean.translation() - Eigen::Vector3d(0, 0.2, 0.4)).norm(), 1e-9);
}

TEST(DeformationGraph, RotationsStayRotationsOverThousandsOfMotions) {
  DeformationGraph graph = ThreeNodes();
  const Rigid3d step = MakeMotion({0.01, 0.02, -0.03}, {0.001, 0, 0});
  for (int i = 0; i < 5000; ++i) ApplyRigidMotion(step, &graph);
  for (const NodeMotion& motion : graph.motions) {
    const Eigen::Matrix3d& r = motion.rotation;
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(r.determinant(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace splitfusion
