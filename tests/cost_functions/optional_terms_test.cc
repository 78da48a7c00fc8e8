// Terms that the default energy lacks.

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/cost_functions/acceleration.h"
#include "splitfusion/cost_functions/normal.h"
#include "splitfusion/cost_functions/point_to_point.h"
#include "splitfusion/cost_functions/point_to_tsdf.h"
#include "splitfusion/cost_functions/projective_depth.h"
#include "splitfusion/cost_functions/symmetric.h"
#include "splitfusion/cost_functions/velocity.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kOptionalTerm{"term", 1, LossKind::kTrivial, 0.01};

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

double EnergyOfTerm(const EnergyTerm& term,
                    const std::vector<Correspondence>& pairs) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  return EnergyOf(
      graph, ResidualsOf(term, {graph, pairs, PinholeCamera()}, kOptionalTerm)
                 .residuals);
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
  EXPECT_EQ(ResidualsOf(VelocityTerm(), input, kOptionalTerm).residual_vectors,
            0);
  input.before = &before;
  const AddedResiduals added =
      ResidualsOf(VelocityTerm(), input, kOptionalTerm);
  EXPECT_EQ(added.residual_vectors, graph.size());
  EXPECT_NEAR(EnergyOf(graph, added.residuals), 25, 1e-9);
  const DeformationGraph rigid = MakeRigidGraph(Rigid3d::Identity());
  EnergyInput body{rigid, {}, PinholeCamera()};
  body.before = &rigid.motions;
  EXPECT_EQ(ResidualsOf(VelocityTerm(), body, kOptionalTerm).residual_vectors,
            0);
}

/// A plate with a node every 4 cm that was in two frames before the live one,
/// frame 2, before a camera that stands still.
class AccelerationTermTest : public ::testing::Test {
 protected:
  AccelerationTermTest() {
    Remember(0, {true, true});
    input_.before = &before_.motions;
    input_.context.frame = &frame_;
    input_.context.history = &history_;
  }

  /// It was seen from frame `first` on, and tracked or not in each.
  void Remember(int first, const std::vector<bool>& tracked) {
    motions_ = MotionLog();
    for (const bool is_tracked : tracked) {
      motions_.Append({first, is_tracked, MovedBy(first).motions});
      ++first;
    }
  }

  /// The plate after so many frames of a constant velocity.
  static DeformationGraph MovedBy(double frames) {
    DeformationGraph graph = PlateGraph();
    for (NodeMotion& motion : graph.motions) {
      motion.translation += frames * Eigen::Vector3d(0.1, -0.2, 0.05);
    }
    return graph;
  }

  AddedResiduals Added() const {
    return ResidualsOf(AccelerationTerm(), input_, kOptionalTerm);
  }

  const DeformationGraph before_ = MovedBy(1);
  DeformationGraph graph_ = MovedBy(2);
  const std::vector<Correspondence> none_;
  const PinholeCamera camera_;
  MotionLog motions_;
  const SurfaceHistory history_{{graph_, motions_}};
  FrameFacts frame_{/*index=*/2};
  EnergyInput input_{graph_, none_, camera_};
};

TEST_F(AccelerationTermTest, IsZeroAtConstantVelocity) {
  EXPECT_EQ(Added().residual_vectors, graph_.size());
  EXPECT_NEAR(EnergyOf(graph_, Added().residuals), 0, 1e-20);
}

TEST_F(AccelerationTermTest, IsTheChangeOfTheVelocity) {
  for (NodeMotion& motion : graph_.motions) {
    motion.translation += Eigen::Vector3d(0.03, 0, -0.04);
  }
  EXPECT_NEAR(EnergyOf(graph_, Added().residuals), 25, 1e-9);
}

TEST_F(AccelerationTermTest, IsAbsentWithoutASteadyPast) {
  const auto expect_none = [&](const std::string& why) {
    EXPECT_EQ(Added().residual_vectors, 0) << why;
  };
  frame_.index = 3;
  expect_none("a frame is missing");
  frame_.index = 2;
  Remember(0, {false, true});
  expect_none("lost");
  Remember(1, {true});
  expect_none("born in the frame before");
  input_.context.history = nullptr;
  expect_none("looked for elsewhere");
}

TEST(NormalTerm, IsTheAngleBetweenTheNormals) {
  // A plate of which the live one is turned by 0.2 rad about its centre.
  const double half_angle = 0.1;
  std::vector<Correspondence> pairs = PlateMovedBy({0.1, 0.2, 0.3});
  for (Correspondence& c : pairs) c.target_normal = c.model.normal;
  EXPECT_NEAR(EnergyOfTerm(NormalTerm(), pairs), 0, 1e-9) << "moved only";
  const Eigen::Matrix3f turn =
      ExpSo3(Eigen::Vector3d(2 * half_angle, 0, 0)).cast<float>();
  for (Correspondence& c : pairs) c.target_normal = turn * c.model.normal;
  // 5 cm a radian.
  const double centimetres = 5 * 2 * std::sin(half_angle);
  EXPECT_NEAR(EnergyOfTerm(NormalTerm(), pairs), centimetres * centimetres,
              1e-5);
}

TEST(NormalTerm, CountsByTheConfidence) {
  std::vector<Correspondence> pairs = PlateMovedBy({0, 0, 0});
  for (Correspondence& c : pairs) {
    c.target_normal = c.model.normal;
    c.weight = 0.25;
  }
  // One that is wrong by a radian, and as much weight as all the others.
  pairs.front().target_normal =
      ExpSo3(Eigen::Vector3d(1, 0, 0)).cast<float>() * pairs[0].model.normal;
  pairs.front().weight = 0.25f * static_cast<float>(pairs.size() - 1);
  const double centimetres = 5 * 2 * std::sin(0.5);
  EXPECT_NEAR(EnergyOfTerm(NormalTerm(), pairs), centimetres * centimetres / 2,
              1e-4);
}

TEST(NormalTerm, IsZeroForTurnsAboutTheNormalAndHasTheRightGradients) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Correspondence c{};
  c.model.point = {0.11f, -0.07f, 1};
  c.model.normal = {0, 0, -1};
  c.model.skinning = SkinningIndex(graph, 6).Skin(c.model.point);
  c.target_normal = c.model.normal;
  const NormalDifference flat = NormalDifference::Make(graph, c, 0.05);
  const int count = c.model.skinning.count;
  ASSERT_GT(count, 1);
  const std::vector<double> turn = {0, 0, 0.7, 0.1, 0.2, 0.3};
  const auto cost = AutoDiffOverTwists(flat, count, 3);
  for (const double r :
       Residuals(*cost, std::vector<std::vector<double>>(count, turn))) {
    EXPECT_NEAR(r, 0, 1e-8);
  }
  Shake(0.05, /*seed=*/1, &graph);
  const auto shaken =
      AutoDiffOverTwists(NormalDifference::Make(graph, c, 0.05), count, 3);
  for (const double size : {0.0, 0.01, 0.3}) {
    EXPECT_GRADIENTS_MATCH(*shaken, RandomTwists(count, size, /*seed=*/2));
  }
}

/// The volume of a slanted wall, and pairs of a plate with live points.
class PointToTsdfTest : public ::testing::Test {
 protected:
  /// The wall leans by as much within half a pixel, centimetres.
  static constexpr double kPixel = 0.15;

  PointToTsdfTest() {
    const DepthObservation wall = ObserveAll(
        SmallCamera(), PlaneDepth(SmallCamera(), normal_, normal_.z()));
    AllocateBand(wall, Rigid3d::Identity(), &volume_);
    IntegrateRigid(wall, Rigid3d::Identity(), &volume_);
    surface_.volume = &volume_;
  }

  /// Root mean square of the residuals, centimetres, where live points are
  /// `off` before the wall, which is carried by `graph`; in rigid rounds where
  /// `start` is given.
  double Distance(double off, const DeformationGraph& graph,
                  const Rigid3d& camera_from_canonical,
                  const DeformationGraph* start = nullptr) {
    std::vector<Correspondence> pairs;
    for (const double x : {-0.1, 0.0, 0.1}) {
      Correspondence& c = pairs.emplace_back();
      // On the wall, and beside what is before it.
      const Eigen::Vector3d point(
          x, 0.05,
          1 - x * normal_.x() / normal_.z() - 0.05 * normal_.y() / normal_.z());
      const Eigen::Vector3d beside =
          point + 0.02 * normal_.cross(Eigen::Vector3d::UnitX());
      c.model.point =
          (start == nullptr ? beside : camera_from_canonical * beside)
              .cast<float>();
      c.model.skinning = SkinningIndex(graph, 6).Skin(c.model.point);
      c.target =
          (camera_from_canonical * (point - off * normal_)).cast<float>();
    }
    EnergyInput input{graph, pairs, camera_};
    input.context.surface = &surface_;
    input.context.surface_graph = start;
    input.context.round.rigid = start != nullptr;
    const AddedResiduals added =
        ResidualsOf(PointToTsdfTerm(), input, kOptionalTerm);
    vectors_ = added.residual_vectors;
    residuals_ = added.residuals;
    return std::sqrt(EnergyOf(graph, added.residuals));
  }

  const Eigen::Vector3d normal_ = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const PinholeCamera camera_;
  TsdfVolume volume_{TsdfOptions{/*voxel_size=*/0.01, /*truncation=*/0.06}};
  SurfaceFacts surface_;
  int vectors_ = 0;          // Of the last Distance(),
  TermResiduals residuals_;  // likewise.
};

TEST_F(PointToTsdfTest, IsTheDistanceAcrossTheSurface) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.4, 0.4, 0.02, 1), 0.08);
  EXPECT_NEAR(Distance(0, graph, Rigid3d::Identity()), 0, kPixel);
  const double before = Distance(0.02, graph, Rigid3d::Identity());
  EXPECT_NEAR(before, 2, kPixel);
  EXPECT_EQ(vectors_, 3);
  // The same wherever the warp carries it.
  const Rigid3d moved = MakeMotion({0.1, -0.3, 0.2}, {0.5, 0.1, -0.2});
  ApplyRigidMotion(moved, &graph);
  EXPECT_NEAR(Distance(0.02, graph, moved), before, 1e-3);
  EXPECT_NEAR(Distance(-0.02, graph, moved), 2, kPixel);
}

TEST_F(PointToTsdfTest, RigidRoundsAreCarriedFromTheCameraFrame) {
  const Rigid3d moved = MakeMotion({0.1, -0.3, 0.2}, {0.5, 0.1, -0.2});
  const DeformationGraph start = MakeRigidGraph(moved);
  const DeformationGraph round = MakeRigidGraph(Rigid3d::Identity());
  EXPECT_NEAR(Distance(0.02, round, moved, &start), 2, kPixel);
  const DeformationGraph bent = PlateGraph();
  Distance(0.02, round, moved, &bent);
  EXPECT_EQ(vectors_, 0) << "where a pair belongs is not known";
}

TEST_F(PointToTsdfTest, LeavesOutWhatTheVolumeDoesNotKnow) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  for (const double off : {0.07, 0.5, -0.3, 1e12}) {
    Distance(off, graph, Rigid3d::Identity());
    EXPECT_EQ(vectors_, 0) << off;
  }
  surface_.volume = nullptr;
  Distance(0.02, graph, Rigid3d::Identity());
  EXPECT_EQ(vectors_, 0) << "without a volume";
}

TEST_F(PointToTsdfTest, PullsTheSurfaceOntoTheLivePoints) {
  Distance(0.02, MakeRigidGraph(Rigid3d::Identity()), Rigid3d::Identity());
  const auto moved_by = [&](double off) {
    return std::sqrt(EnergyOf(
        MakeRigidGraph(MakeMotion({0, 0, 0}, -off * normal_)), residuals_));
  };
  EXPECT_NEAR(moved_by(0.02), 0, kPixel);
  EXPECT_NEAR(moved_by(-0.02), 4, kPixel);
}

}  // namespace
}  // namespace splitfusion
