// WarpedPointGroup, which the solver uses, against plain autodiff with Ceres'
// own losses.

#include "splitfusion/lib/energy/warped_point_group.h"

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/energy/residual_sink.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

struct PointToPoint {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d target;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d] - T(target[d]);
    return true;
  }
};

PointToPlane MakeFunctor(const Correspondence& c, const PointToPlane*) {
  return {c.warped_normal.cast<double>(), c.target.cast<double>(), 0.7};
}

PointToPoint MakeFunctor(const Correspondence& c, const PointToPoint*) {
  return {c.target.cast<double>()};
}

/// A point functor in units of kResidualUnit.
template <typename PointFunctor>
struct InUnits {
  PointFunctor functor;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    if (!functor(x, residual)) return false;
    for (int d = 0; d < PointFunctor::kResiduals; ++d) {
      residual[d] *= T(1 / kResidualUnit);
    }
    return true;
  }
};

struct Evaluation {
  double cost = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd gauss_newton;  ///< J^T J
};

Evaluation Evaluate(ceres::Problem* problem) {
  Evaluation evaluation;
  std::vector<double> gradient;
  ceres::CRSMatrix jacobian;
  EXPECT_TRUE(problem->Evaluate(ceres::Problem::EvaluateOptions(),
                                &evaluation.cost, nullptr, &gradient,
                                &jacobian));
  evaluation.gradient =
      Eigen::Map<Eigen::VectorXd>(gradient.data(), gradient.size());
  Eigen::MatrixXd dense =
      Eigen::MatrixXd::Zero(jacobian.num_rows, jacobian.num_cols);
  for (int row = 0; row < jacobian.num_rows; ++row) {
    for (int e = jacobian.rows[row]; e < jacobian.rows[row + 1]; ++e) {
      dense(row, jacobian.cols[e]) = jacobian.values[e];
    }
  }
  evaluation.gauss_newton = dense.transpose() * dense;
  return evaluation;
}

/// A shaken plate whose points are up to centimetres off: inliers and outliers
/// of every loss.
class Scene {
 public:
  Scene() : graph_(CoverWithNodes(mesh_, 0.04)) {
    Shake(0.01, /*seed=*/1, &graph_);
    correspondences_ = PerfectAssociation(
        mesh_, graph_, [](const Eigen::Vector3d& p) -> Eigen::Vector3d {
          return p + 0.03 * Eigen::Vector3d(std::sin(90 * p.x()),
                                            std::cos(70 * p.y()),
                                            std::sin(50 * p.x() + 60 * p.y()));
        });
    twists_ = RandomTwists(graph_.size(), 0.02, /*seed=*/2);
  }

  /// One Ceres block a point: plain dynamic autodiff and Ceres' loss.
  template <typename PointFunctor>
  Evaluation Plain(const TermOptions& options) {
    ceres::Problem problem;
    AddTwists(&problem);
    const double weight =
        2 * options.weight / static_cast<double>(correspondences_.size());
    for (const Correspondence& c : correspondences_) {
      using Functor = InUnits<PointFunctor>;
      const Functor functor{
          MakeFunctor(c, static_cast<const PointFunctor*>(nullptr))};
      auto cost =
          AutoDiffOverTwists(WarpFunctor<Functor>(graph_, c.model.skinning,
                                                  c.model.point, functor),
                             c.model.skinning.count, PointFunctor::kResiduals);
      problem.AddResidualBlock(
          cost.release(),
          new ceres::ScaledLoss(
              MakeLoss(options.loss, options.scale / kResidualUnit).release(),
              weight, ceres::TAKE_OWNERSHIP),
          Blocks({c.model.skinning.nodes.begin(),
                  c.model.skinning.nodes.begin() + c.model.skinning.count}));
    }
    return Evaluate(&problem);
  }

  /// What the sink makes of the same.
  template <typename PointFunctor>
  Evaluation Grouped(const TermOptions& options) {
    std::vector<const ModelSample*> samples;
    std::vector<PointFunctor> functors;
    for (const Correspondence& c : correspondences_) {
      samples.push_back(&c.model);
      functors.push_back(
          MakeFunctor(c, static_cast<const PointFunctor*>(nullptr)));
    }
    ResidualSink sink(graph_, options, 1);
    sink.AddWarpedPoints(samples, functors);
    EXPECT_LT(sink.blocks().size(), samples.size());
    ceres::Problem problem;
    AddTwists(&problem);
    for (ResidualBlock& block : sink.blocks()) {
      EXPECT_EQ(block.loss, nullptr);
      problem.AddResidualBlock(block.cost.release(), nullptr,
                               Blocks(block.nodes));
    }
    return Evaluate(&problem);
  }

 private:
  void AddTwists(ceres::Problem* problem) {
    for (auto& twist : twists_) problem->AddParameterBlock(twist.data(), 6);
  }
  std::vector<double*> Blocks(const std::vector<int>& nodes) {
    std::vector<double*> blocks;
    for (const int node : nodes) blocks.push_back(twists_[node].data());
    return blocks;
  }

  const TriangleMesh mesh_ = PlateMesh(0.2, 0.15, 0.01, 1);
  DeformationGraph graph_;
  std::vector<Correspondence> correspondences_;
  std::vector<std::vector<double>> twists_;
};

void ExpectEqual(const Evaluation& a, const Evaluation& b) {
  EXPECT_GT(a.cost, 0);
  EXPECT_NEAR(a.cost, b.cost, 1e-10 * a.cost);
  EXPECT_LT((a.gradient - b.gradient).norm(), 1e-10 * a.gradient.norm());
  EXPECT_LT((a.gauss_newton - b.gauss_newton).norm(),
            1e-10 * a.gauss_newton.norm());
}

class WarpedPointGroupTest : public ::testing::TestWithParam<LossKind> {};

TEST_P(WarpedPointGroupTest, PointToPlaneEqualsPlainAutoDiff) {
  Scene scene;
  const TermOptions options{"", 2.5, GetParam(), 0.012};
  ExpectEqual(scene.Plain<PointToPlane>(options),
              scene.Grouped<PointToPlane>(options));
}

TEST_P(WarpedPointGroupTest, VectorResidualsEqualPlainAutoDiff) {
  Scene scene;
  const TermOptions options{"", 2.5, GetParam(), 0.03};
  ExpectEqual(scene.Plain<PointToPoint>(options),
              scene.Grouped<PointToPoint>(options));
}

INSTANTIATE_TEST_SUITE_P(Losses, WarpedPointGroupTest,
                         ::testing::Values(LossKind::kTrivial, LossKind::kHuber,
                                           LossKind::kTukey, LossKind::kCauchy),
                         [](const auto& info) { return ToString(info.param); });

TEST(WarpedPointGroup, GradientsMatchNumericWithoutLoss) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.1, /*seed=*/1, &graph);
  const Eigen::Vector3f point(0.11f, 0.07f, 1);
  const Skinning skinning = SkinningIndex(graph, 6).Skin(point);
  WarpedPointGroup<PointToPoint> group(
      graph,
      std::vector<int>(skinning.nodes.begin(),
                       skinning.nodes.begin() + skinning.count),
      100, 0.5, std::make_shared<ceres::TrivialLoss>());
  group.Add(graph, skinning, point, {{0.1, 0.1, 1.1}});
  group.Add(graph, skinning, point, {{0.2, 0.1, 0.9}});
  EXPECT_EQ(group.num_residuals(), 7);
  EXPECT_GRADIENTS_MATCH(group, RandomTwists(skinning.count, 0.3, /*seed=*/2));
}

TEST(WarpedPointGroup, JacobiansOfConstantNodesMayBeLeftOut) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  Skinning skinning;
  skinning.count = 1;
  skinning.weights[0] = 1;
  WarpedPointGroup<PointToPoint> group(graph, {0}, 1, 1,
                                       std::make_shared<ceres::TrivialLoss>());
  group.Add(graph, skinning, {0, 0, 1}, {{0, 0, 3}});
  const std::vector<double> twist(6, 0);
  const double* twists[1] = {twist.data()};
  double residuals[4];
  double* none[1] = {nullptr};
  ASSERT_TRUE(group.Evaluate(twists, residuals, none));
  EXPECT_NEAR(residuals[2], -2, 1e-12);
  EXPECT_EQ(residuals[3], 0);
}

}  // namespace
}  // namespace splitfusion
