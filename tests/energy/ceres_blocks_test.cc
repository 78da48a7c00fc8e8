// The blocks that the solvers use against plain autodiff with Ceres' own
// losses.

#include "splitfusion/lib/energy/ceres_blocks.h"

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "splitfusion/lib/energy/warped_points.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

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

/// A functor for each correspondence.
template <typename PointFunctor>
class PointTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    std::vector<PointFunctor> functors;
    for (const Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
      functors.push_back(
          MakeFunctor(c, static_cast<const PointFunctor*>(nullptr)));
    }
    sink->AddWarpedPoints(samples, functors);
  }
};

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

  /// The same by the blocks that Ceres is given.
  template <typename PointFunctor>
  Evaluation Grouped(const TermOptions& options) {
    ceres::Problem problem;
    AddTwists(&problem);
    std::size_t blocks = 0;
    const AddedResiduals added =
        ResidualsOf(PointTerm<PointFunctor>(), Input(), options);
    for (ResidualBlock& block : MakeCeresBlocks(graph_, added.residuals)) {
      problem.AddResidualBlock(block.cost.release(), nullptr,
                               Blocks(block.nodes));
      ++blocks;
    }
    EXPECT_LT(blocks, correspondences_.size());
    return Evaluate(&problem);
  }

  /// The same by assembled normal equations.
  template <typename PointFunctor>
  Evaluation Assembled(const TermOptions& options) {
    const Energy energy = {
        {options, std::make_shared<PointTerm<PointFunctor>>()}};
    BlockProblem problem({energy, correspondences_, PinholeCamera()}, graph_);
    std::vector<double> flat;
    for (const auto& twist : twists_) {
      flat.insert(flat.end(), twist.begin(), twist.end());
    }
    EXPECT_TRUE(problem.Evaluate(flat, /*with_jacobians=*/true));
    BorderedMatrix matrix = problem.MakeMatrix();
    BorderedVector gradient;
    problem.Assemble(&matrix, &gradient);
    Evaluation evaluation;
    evaluation.cost = problem.Cost();
    evaluation.gradient =
        Eigen::Map<Eigen::VectorXd>(gradient.nodes[0].data(), flat.size());
    evaluation.gauss_newton = Dense(matrix.nodes);
    return evaluation;
  }

 private:
  EnergyInput Input() const {
    return {graph_, correspondences_, PinholeCamera()};
  }
  static Eigen::MatrixXd Dense(const SymmetricBlockMatrix& matrix) {
    const int size = 6 * matrix.size();
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < matrix.size(); ++i) {
      for (int e = matrix.row_begin()[i]; e < matrix.row_begin()[i + 1]; ++e) {
        const int j = matrix.columns()[e];
        dense.block<6, 6>(6 * i, 6 * j) = matrix.blocks()[e];
        dense.block<6, 6>(6 * j, 6 * i) = matrix.blocks()[e].transpose();
      }
    }
    return dense;
  }
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

class CeresBlocksTest : public ::testing::TestWithParam<LossKind> {};

TEST_P(CeresBlocksTest, PointToPlaneEqualsPlainAutoDiff) {
  Scene scene;
  const TermOptions options{"", 2.5, GetParam(), 0.012};
  const Evaluation plain = scene.Plain<PointToPlane>(options);
  ExpectEqual(plain, scene.Grouped<PointToPlane>(options));
  ExpectEqual(plain, scene.Assembled<PointToPlane>(options));
}

TEST_P(CeresBlocksTest, VectorResidualsEqualPlainAutoDiff) {
  Scene scene;
  const TermOptions options{"", 2.5, GetParam(), 0.03};
  const Evaluation plain = scene.Plain<PointToPoint>(options);
  ExpectEqual(plain, scene.Grouped<PointToPoint>(options));
  ExpectEqual(plain, scene.Assembled<PointToPoint>(options));
}

INSTANTIATE_TEST_SUITE_P(Losses, CeresBlocksTest,
                         ::testing::Values(LossKind::kTrivial, LossKind::kHuber,
                                           LossKind::kTukey, LossKind::kCauchy),
                         [](const auto& info) { return ToString(info.param); });

/// A block of two points over their nodes.
std::vector<ResidualBlock> TwoPoints(const DeformationGraph& graph,
                                     const ModelSample& sample,
                                     const TermOptions& options) {
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  sink.AddWarpedPoints(
      {&sample, &sample},
      std::vector<PointToPoint>{{{0.1, 0.1, 1.1}}, {{0.2, 0.1, 0.9}}});
  return MakeCeresBlocks(graph, sink.residuals());
}

TEST(CeresBlocks, GradientsMatchNumericWithoutLoss) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.1, /*seed=*/1, &graph);
  ModelSample sample;
  sample.point = {0.11f, 0.07f, 1};
  sample.skinning = SkinningIndex(graph, 6).Skin(sample.point);
  const auto blocks = TwoPoints(graph, sample, TermOptions());
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].cost->num_residuals(), 6);
  EXPECT_GRADIENTS_MATCH(*blocks[0].cost,
                         RandomTwists(sample.skinning.count, 0.3, /*seed=*/2));
}

TEST(CeresBlocks, JacobiansOfConstantNodesMayBeLeftOut) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  ModelSample sample;
  sample.point = {0, 0, 1};
  sample.skinning.count = 1;
  sample.skinning.weights[0] = 1;
  const auto blocks = TwoPoints(graph, sample, {"", 1, LossKind::kHuber, 0.5});
  const std::vector<double> twist(6, 0);
  const double* twists[1] = {twist.data()};
  double residuals[7];
  double* none[1] = {nullptr};
  ASSERT_EQ(blocks[0].cost->num_residuals(), 7);
  ASSERT_TRUE(blocks[0].cost->Evaluate(twists, residuals, none));
  // Centimetres; a weight of 1 over two points and Ceres' 1/2 cancel.
  EXPECT_NEAR(residuals[2], -10, 1e-9);
  EXPECT_NEAR(residuals[6], 0, 1e-6);
}

}  // namespace
}  // namespace splitfusion
