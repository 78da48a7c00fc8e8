#include "splitfusion/cost_functions/point_to_plane.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

double Value(const PointToPlane& functor, const Eigen::Vector3d& x) {
  double residual = 0;
  functor(x.data(), &residual);
  return residual;
}

PointToPlane SamplePlane() {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -2, -3).normalized();
  return {normal, {0.1, 0.2, 1.5}, 1};
}

/// A point carried by six shaken nodes of a plate, over its twists.
struct CarriedPoint {
  CarriedPoint() : graph(CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04)) {
    Shake(0.1, /*seed=*/1, &graph);
    skinning = SkinningIndex(graph, 6).Skin(point);
  }
  WarpFunctor<PointToPlane> Functor(const PointToPlane& plane) const {
    return {graph, skinning, point, plane};
  }
  double Value(const PointToPlane& plane,
               const std::vector<std::vector<double>>& twists) const {
    const auto cost = AutoDiffOverTwists(Functor(plane), skinning.count, 1);
    return Residuals(*cost, twists).at(0);
  }

  Eigen::Vector3f point{0.11f, 0.07f, 1.f};
  DeformationGraph graph;
  Skinning skinning;
};

TEST(PointToPlane, ValueByHand) {
  const PointToPlane functor{{0, 0.6, -0.8}, {1, 2, 3}, 2};
  // (0, 0.6, -0.8) . (1, 5, 5) = 3 - 4 = -1, times 2.
  EXPECT_NEAR(Value(functor, {2, 7, 8}), -2, 1e-12);
}

TEST(PointToPlane, DoesNotChangeWithinTheTangentPlane) {
  const PointToPlane plane = SamplePlane();
  const Eigen::Vector3d along = plane.normal.unitOrthogonal();
  const Eigen::Vector3d across = plane.normal.cross(along);
  const Eigen::Vector3d x(0.3, -0.1, 1.2);
  const double value = Value(plane, x);
  EXPECT_NEAR(Value(plane, x + 0.5 * along - 2 * across), value, 1e-12);
  EXPECT_NEAR(Value(plane, x + 0.01 * plane.normal), value + 0.01, 1e-12);
}

TEST(PointToPlane, DoesNotChangeWhenPointAndPlaneMoveTogether) {
  const PointToPlane plane = SamplePlane();
  const Rigid3d motion = MakeMotion({0.4, 1.1, -0.6}, {3, -2, 1});
  const PointToPlane moved{motion.linear() * plane.normal,
                           motion * plane.target, 1};
  const Eigen::Vector3d x(0.3, -0.1, 1.2);
  EXPECT_NEAR(Value(moved, motion * x), Value(plane, x), 1e-12);
}

TEST(PointToPlane, OverNodesIsTheDistanceOfTheWarpedPoint) {
  const CarriedPoint carried;
  const Eigen::Vector3f warped =
      WarpField(carried.graph).WarpPoint(carried.skinning, carried.point);
  const auto rest = RandomTwists(carried.skinning.count, 0, /*seed=*/1);
  EXPECT_NEAR(carried.Value(SamplePlane(), rest),
              Value(SamplePlane(), warped.cast<double>()), 1e-6);
}

TEST(PointToPlane, ACommonTranslationCountsByItsPartAlongTheNormal) {
  const CarriedPoint carried;
  auto twists = RandomTwists(carried.skinning.count, 0, /*seed=*/1);
  const PointToPlane plane = SamplePlane();
  const double before = carried.Value(plane, twists);
  for (auto& twist : twists) twist = {0, 0, 0, 0.1, 0.2, -0.3};
  // The weights, floats, sum to 1 up to 1e-7.
  EXPECT_NEAR(carried.Value(plane, twists) - before,
              plane.normal.dot(Eigen::Vector3d(0.1, 0.2, -0.3)), 1e-6);
}

TEST(PointToPlane, DerivativesAtRestAreThoseOfTheComment) {
  const CarriedPoint carried;
  const PointToPlane plane = SamplePlane();
  const auto cost =
      AutoDiffOverTwists(carried.Functor(plane), carried.skinning.count, 1);
  const std::vector<double> zero(6, 0);
  const std::vector<const double*> twists(carried.skinning.count, zero.data());
  std::vector<std::array<double, 6>> rows(carried.skinning.count);
  std::vector<double*> jacobians;
  for (auto& row : rows) jacobians.push_back(row.data());
  double residual = 0;
  ASSERT_TRUE(cost->Evaluate(twists.data(), &residual, jacobians.data()));
  for (int k = 0; k < carried.skinning.count; ++k) {
    const NodeTransport node = MakeTransport(
        carried.graph, carried.skinning.nodes[k], carried.skinning.weights[k],
        carried.point.cast<double>());
    const Eigen::Map<const Eigen::Vector3d> by_omega(rows[k].data());
    const Eigen::Map<const Eigen::Vector3d> by_tau(rows[k].data() + 3);
    EXPECT_LT((by_tau - node.weight * plane.normal).norm(), 1e-12);
    EXPECT_LT(
        (by_omega - node.weight * node.rotated.cross(plane.normal)).norm(),
        1e-12);
  }
}

TEST(PointToPlane, GradientsMatchNumeric) {
  const CarriedPoint carried;
  const auto cost = AutoDiffOverTwists(carried.Functor(SamplePlane()),
                                       carried.skinning.count, 1);
  for (const double size : {0.0, 0.01, 1.0}) {
    EXPECT_GRADIENTS_MATCH(
        *cost, RandomTwists(carried.skinning.count, size, /*seed=*/7));
  }
}

TEST(PointToPlaneTerm, IsTheMeanWeightedByTheConfidence) {
  const TriangleMesh mesh = PlateMesh(0.1, 0.1, 0.02, 1);
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  auto correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return p + Eigen::Vector3d(0.3, 0, 0.02);
      });
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    correspondences[i].weight = i == 0 ? 0.5f : 0.25f;
  }
  correspondences[0].target = correspondences[0].model.point;
  const TermOptions options{"point_to_plane", 1, LossKind::kTrivial, 0.01};
  const AddedResiduals added = ResidualsOf(
      PointToPlaneTerm(), {graph, correspondences, PinholeCamera()}, options);
  EXPECT_EQ(added.residual_vectors, static_cast<int>(correspondences.size()));
  // 2 cm off, in cm: 4; the first one, of twice the weight, is not off.
  const double others = 0.25 * (correspondences.size() - 1.0);
  EXPECT_NEAR(EnergyOf(graph, added.residuals), 4 * others / (0.5 + others),
              1e-4);
}

}  // namespace
}  // namespace splitfusion
