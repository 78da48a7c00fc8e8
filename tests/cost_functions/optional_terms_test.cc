// Terms that the default energy lacks.

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/point_to_point.h"
#include "splitfusion/cost_functions/projective_depth.h"
#include "splitfusion/cost_functions/symmetric.h"
#include "splitfusion/cost_functions/velocity.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kOptions{"term", 1, LossKind::kTrivial, 0.01};

template <typename Functor>
Eigen::Vector3d Value(const Functor& functor, const Eigen::Vector3d& x) {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  EXPECT_TRUE(functor(x.data(), residual.data()));
  return residual;
}

/// Gradients over the nodes that carry a point.
template <typename Functor>
void ExpectGradients(const Functor& functor) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.05, /*seed=*/1, &graph);
  const Eigen::Vector3f point(0.11f, -0.07f, 1);
  const Skinning skinning = SkinningIndex(graph, 6).Skin(point);
  const auto cost =
      AutoDiffOverTwists(WarpFunctor<Functor>(graph, skinning, point, functor),
                         skinning.count, Functor::kResiduals);
  for (const double size : {0.0, 0.01, 0.3}) {
    EXPECT_GRADIENTS_MATCH(*cost,
                           RandomTwists(skinning.count, size, /*seed=*/2));
  }
}

/// Pairs of a plate with itself, moved.
std::vector<Correspondence> PlateMovedBy(const Eigen::Vector3d& way) {
  return PerfectAssociation(
      PlateMesh(0.1, 0.1, 0.02, 1), MakeRigidGraph(Rigid3d::Identity()),
      [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + way; });
}

double EnergyOfTerm(const EnergyTerm& term,
                    const std::vector<Correspondence>& pairs) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  return EnergyOf(
      graph,
      ResidualsOf(term, {graph, pairs, PinholeCamera()}, kOptions).residuals);
}

TEST(PointToPoint, IsTheWholeWay) {
  EXPECT_TRUE(Value(PointToPoint{{1, 2, 3}, 0.5}, {1.2, 2, 2})
                  .isApprox(Eigen::Vector3d(0.1, 0, -0.5)));
  ExpectGradients(PointToPoint{{0.1, -0.06, 1.1}, 0.7});
}

TEST(PointToPointTerm, SeesWhatSlidesAlongItself) {
  EXPECT_NEAR(EnergyOfTerm(PointToPointTerm(), PlateMovedBy({0.03, 0.04, 0})),
              25, 1e-3);
  EXPECT_NEAR(EnergyOfTerm(PointToPlaneTerm(), PlateMovedBy({0.03, 0.04, 0})),
              0, 1e-6);
}

TEST(SymmetricTerm, IsZeroOnACircle) {
  // Two points of a circle in the x-z plane, with their outward normals.
  const auto on_circle = [](double angle) {
    return Eigen::Vector3f(static_cast<float>(std::sin(angle)), 0,
                           static_cast<float>(-std::cos(angle)));
  };
  const Eigen::Vector3f center(0, 0, 2);
  Correspondence c{};
  c.model.skinning.count = 1;
  c.model.skinning.weights[0] = 1;
  c.warped_normal = on_circle(0.2);
  c.model.normal = c.warped_normal;
  c.model.point = center + 0.5f * c.warped_normal;
  c.target_normal = on_circle(-0.3);
  c.target = center + 0.5f * c.target_normal;
  EXPECT_NEAR(EnergyOfTerm(SymmetricTerm(), {c}), 0, 1e-6);
  EXPECT_GT(EnergyOfTerm(PointToPlaneTerm(), {c}), 1);
}

TEST(SymmetricTerm, IsPointToPlaneWhereNormalsAgree) {
  const std::vector<Correspondence> moved = PlateMovedBy({0.01, 0, 0.02});
  EXPECT_NEAR(EnergyOfTerm(SymmetricTerm(), moved),
              EnergyOfTerm(PointToPlaneTerm(), moved), 1e-6);
}

TEST(ProjectiveDepth, IsTheDifferenceOfDepthAtThePixel) {
  // A plane through (0, 0, 2) that leans; the ray through (0.1, 0, 1) meets it
  // where z = 2 + x, so at z = 2 / 0.9.
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0, -1).normalized();
  const ProjectiveDepth depth{normal, normal.dot(Eigen::Vector3d(0, 0, 2)), 1};
  EXPECT_NEAR(Value(depth, {0.15, 0, 1.5})[0], 1.5 - 2 / 0.9, 1e-12);
  EXPECT_NEAR(Value(depth, {0.4, 0.3, 2.4})[0], 0, 1e-12) << "on the plane";
  ExpectGradients(depth);
}

TEST(ProjectiveDepth, IsUndefinedWhereTheRayNeverMeetsThePlane) {
  const ProjectiveDepth depth{{1, 0, 0}, 0.5, 1};
  double residual = 0;
  const double x[] = {0, 0.2, 1};
  EXPECT_FALSE(depth(x, &residual));
}

TEST(ProjectiveDepthTerm, CountsAlongTheViewRay) {
  EXPECT_NEAR(EnergyOfTerm(ProjectiveDepthTerm(), PlateMovedBy({0, 0, 0.02})),
              4, 1e-3);
}

TEST(VelocityTerm, IsTheWaySinceTheFrameBefore) {
  DeformationGraph graph = PlateGraph();
  const std::vector<NodeMotion> before = graph.motions;
  for (NodeMotion& motion : graph.motions) {
    motion.translation += Eigen::Vector3d(0.03, 0, -0.04);
  }
  EnergyInput input{graph, {}, PinholeCamera()};
  EXPECT_EQ(ResidualsOf(VelocityTerm(), input, kOptions).residual_vectors, 0);
  input.before = &before;
  const AddedResiduals added = ResidualsOf(VelocityTerm(), input, kOptions);
  EXPECT_EQ(added.residual_vectors, graph.size());
  EXPECT_NEAR(EnergyOf(graph, added.residuals), 25, 1e-9);
  const DeformationGraph rigid = MakeRigidGraph(Rigid3d::Identity());
  EnergyInput body{rigid, {}, PinholeCamera()};
  body.before = &rigid.motions;
  EXPECT_EQ(ResidualsOf(VelocityTerm(), body, kOptions).residual_vectors, 0);
}

}  // namespace
}  // namespace splitfusion
