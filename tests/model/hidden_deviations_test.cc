#include "splitfusion/lib/model/hidden_deviations.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/frozen_problem.h"
#include "splitfusion/lib/energy/gradient_check.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/pipelines/refine_pass.h"
#include "support/expect_input_error.h"
#include "support/hidden_plate.h"
#include "support/motion_frames.h"
#include "support/sample_graphs.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Weighted second difference in time of a node's centre, in the world.
struct SmoothInTime {
  std::array<Eigen::Vector3d, 3> centers;  // Camera frames.
  std::array<Rigid3d, 3> poses;            // World from camera.
  double root;

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    Eigen::Matrix<T, 3, 1> sum = Eigen::Matrix<T, 3, 1>::Zero();
    constexpr std::array<double, 3> kWeights = {1, -2, 1};
    for (int k = 0; k < 3; ++k) {
      Eigen::Matrix<T, 3, 1> center = centers[k].cast<T>();
      for (int d = 0; d < 3; ++d) center[d] += twists[k][3 + d];
      sum += T(root * kWeights[k]) * (poses[k].linear().cast<T>() * center +
                                      poses[k].translation().cast<T>());
    }
    for (int d = 0; d < 3; ++d) residual[d] = sum[d];
    return true;
  }
};

/// The same energy as a Ceres problem over the twists of all nodes, those that
/// were seen held.
class CeresReference {
 public:
  CeresReference(const std::map<int, Rigid3d>& poses, double smoothness,
                 const SurfaceModel& model)
      : nodes_(model.graph.size()),
        twists_(model.history.size() * nodes_, {{}}) {
    const std::vector<FrameMotions> frames = FramesOf(model.history);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      for (int i = 0; i < nodes_; ++i) {
        problem_.AddParameterBlock(Twist(f, i), 6);
        if (frames[f].Saw(i)) problem_.SetParameterBlockConstant(Twist(f, i));
      }
    }
    for (std::size_t f = 0; f < frames.size(); ++f) {
      AddEdges(model.graph, frames[f].motions, f);
      if (f > 0 && f + 1 < frames.size()) {
        AddDifferences(poses, smoothness, model, f);
      }
    }
  }

  /// Solves it; the least cost, twice Ceres'.
  double LeastCost() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-12;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return 2 * (summary.final_cost - summary.fixed_cost);
  }

  /// Deviations of one coordinate of the places of all hidden nodes, in time,
  /// then by node, if the residuals are off by `arap` and `smoothness`:
  /// (J^T J)^-1 J^T, by these, times its transpose.
  std::vector<double> Deviations(double arap, double smoothness) {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = residuals_;
    for (auto& twist : twists_) {
      if (problem_.IsParameterBlockConstant(twist.data())) continue;
      options.parameter_blocks.push_back(twist.data());
    }
    ceres::CRSMatrix sparse;
    EXPECT_TRUE(problem_.Evaluate(options, nullptr, nullptr, nullptr, &sparse));
    Eigen::MatrixXd jacobian =
        Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    Eigen::VectorXd sigmas(sparse.num_rows);
    for (int row = 0; row < sparse.num_rows; ++row) {
      for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k) {
        jacobian(row, sparse.cols[k]) = sparse.values[k];
      }
      sigmas[row] = is_edge_[row / 3] ? arap : smoothness;
    }
    const Eigen::MatrixXd spread =
        (jacobian.transpose() * jacobian).ldlt().solve(jacobian.transpose()) *
        sigmas.asDiagonal();
    std::vector<double> deviations;
    for (int at = 0; at < spread.rows(); at += 6) {
      deviations.push_back(
          std::sqrt(spread.middleRows<3>(at + 3).squaredNorm() / 3));
    }
    return deviations;
  }

 private:
  double* Twist(std::size_t frame, int node) {
    return twists_[frame * nodes_ + node].data();
  }

  template <typename Functor>
  void Add(bool is_edge, Functor* functor, const std::vector<double*>& blocks) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Functor>(functor);
    for (std::size_t k = 0; k < blocks.size(); ++k) cost->AddParameterBlock(6);
    cost->SetNumResiduals(3);
    residuals_.push_back(problem_.AddResidualBlock(cost, nullptr, blocks));
    is_edge_.push_back(is_edge);
  }

  void AddEdges(DeformationGraph graph, const std::vector<NodeMotion>& motions,
                std::size_t f) {
    graph.motions = motions;
    for (int i = 0; i < nodes_; ++i) {
      for (const int j : graph.neighbors[i]) {
        Add(true, new Arap(Arap::Make(graph, i, j)),
            {Twist(f, i), Twist(f, j)});
      }
    }
  }

  void AddDifferences(const std::map<int, Rigid3d>& poses, double smoothness,
                      const SurfaceModel& model, std::size_t f) {
    for (int i = 0; i < nodes_; ++i) {
      auto* smooth = new SmoothInTime;
      std::vector<double*> blocks;
      for (int k = 0; k < 3; ++k) {
        const FrameMotions frame =
            model.history.At(static_cast<int>(f) + k - 1);
        smooth->centers[k] =
            model.graph.positions[i] + frame.motions[i].translation;
        smooth->poses[k] = poses.at(frame.frame);
        blocks.push_back(Twist(f + k - 1, i));
      }
      smooth->root = std::sqrt(smoothness);
      Add(false, smooth, blocks);
    }
  }

  int nodes_;
  std::vector<std::array<double, 6>> twists_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> residuals_;
  std::vector<bool> is_edge_;  // By residual block.
};

/// A plate that bends, walks and sinks, most of it hidden in frames 3 to 8.
class BendingPlate : public testing::Test {
 protected:
  BendingPlate() {
    const auto is_right = [&](int i) {
      return model_.graph.positions[i].x() > -0.05;
    };
    Hide(3, 8, is_right, &model_);
  }

  const std::map<int, Rigid3d> poses_ = Poses(FramesUpTo(12));
  SurfaceModel model_ =
      SeenPlate(poses_, [](const Eigen::Vector3d& p, int frame) {
        const double curvature = 0.2 * frame;
        return Walk(curvature > 0 ? Bend(p, 1, curvature) : p, frame);
      });
};

using HiddenMotionsAndCeres = BendingPlate;

TEST_F(HiddenMotionsAndCeres, SolveTheSameWindow) {
  // Its graph is of what is sought, and known are the ends of its links.
  const SurfaceModel before = model_;
  std::vector<WindowProblem> windows;
  RefineHiddenMotions(poses_, {}, &model_, [&](const WindowProblem& window) {
    windows.push_back(window);
  });
  ASSERT_EQ(windows.size(), 1u);
  const WindowProblem& window = windows[0];
  EXPECT_EQ(window.graph.size(), window.report.hidden);
  const FrozenProblem problem = FreezeWindow(window, 3, 100);
  EXPECT_EQ(problem.surface, 3);
  const double unit = window.links.edges.size() * kResidualUnit * kResidualUnit;
  const auto sum = [](const HiddenMotionCost& c) {
    return c.arap + c.smoothness;
  };
  EXPECT_NEAR(problem.start.cost * unit, sum(window.report.initial),
              1e-9 * sum(window.report.initial));
  EXPECT_NEAR(problem.start.terms[0] * unit, window.report.initial.arap,
              1e-9 * window.report.initial.arap);
  const double least = CeresReference(poses_, 100, before).LeastCost();
  for (const char* name : {"ceres", "gn_cholesky", "gn_pcg"}) {
    SolverOptions options;
    options.solver = name;
    options.max_iterations = 200;
    options.eta = 1e-3;
    DeformationGraph graph = problem.graph;
    const SolverReport report = Minimize(problem.View(), options, &graph);
    EXPECT_NEAR(report.final_cost * unit, least, 1e-3 * least) << name;
    EXPECT_GT(problem.final_cost, 0.99 * report.final_cost) << name;
    EXPECT_LT(problem.final_cost, 1.02 * report.final_cost) << name;
  }
}

TEST_F(HiddenMotionsAndCeres, WindowsSurviveFreezing) {
  const TemporaryFolder folder;
  std::optional<FrozenProblem> problem;
  RefineHiddenMotions(poses_, {}, &model_, [&](const WindowProblem& window) {
    problem = FreezeWindow(window, 1, 100);
  });
  WriteFrozenProblem(folder / "window.h5", *problem);
  const FrozenProblem read =
      ReadFrozenProblem(folder / "window.h5", BuiltinTerms());
  EXPECT_EQ(read.links->edges, problem->links->edges);
  EXPECT_EQ(read.links->triples, problem->links->triples);
  EXPECT_EQ(read.final_cost, problem->final_cost);
  const ProblemStart start = EvaluateStart(read.View(), read.graph);
  EXPECT_EQ(start.cost, problem->start.cost);
  EXPECT_EQ(start.gradient, problem->start.gradient);
  for (const GradientError& error : CheckGradients(read.View(), read.graph)) {
    EXPECT_GT(error.residuals, 0) << error.term;
    EXPECT_LT(error.relative, 1e-6) << error.term;
  }
  problem->links->edges[0][1] = 1 << 20;
  WriteFrozenProblem(folder / "window.h5", *problem);
  ExpectInputError(
      [&] { ReadFrozenProblem(folder / "window.h5", BuiltinTerms()); },
      "hidden_edges/nodes: expected different ones of");
}

TEST_F(HiddenMotionsAndCeres, FindTheSameLeastEnergy) {
  const SurfaceModel before = model_;
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(poses_, {}, &model_);
  ASSERT_EQ(windows.size(), 1u);
  const double cost = windows[0].final.arap + windows[0].final.smoothness;
  for (const SurfaceModel* start : {&before, &std::as_const(model_)}) {
    const double least = CeresReference(poses_, 100, *start).LeastCost();
    EXPECT_GT(cost, 0.99 * least);
    EXPECT_LT(cost, 1.02 * least);
  }
}

/// Root mean squares of the residuals of Eq. 6, and of the smoothness in time
/// with its weight, of nodes that were seen.
std::pair<double, double> SeenResiduals(const std::map<int, Rigid3d>& poses,
                                        double smoothness,
                                        const SurfaceModel& model) {
  const std::vector<FrameMotions> frames = FramesOf(model.history);
  double sums[2] = {};
  int counts[2] = {};
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto place = [&](std::size_t frame, int i) {
      const FrameMotions& at = frames[frame];
      return Eigen::Vector3d(poses.at(at.frame) * (model.graph.positions[i] +
                                                   at.motions[i].translation));
    };
    for (int i = 0; i < model.graph.size(); ++i) {
      if (!frames[f].Saw(i)) continue;
      for (const int j : model.graph.neighbors[i]) {
        if (!frames[f].Saw(j)) continue;
        const Eigen::Vector3d rest =
            model.graph.positions[i] - model.graph.positions[j];
        sums[0] += (place(f, i) - place(f, j) -
                    poses.at(frames[f].frame).linear() *
                        frames[f].motions[i].rotation * rest)
                       .squaredNorm();
        counts[0] += 3;
      }
      if (f == 0 || f + 1 == frames.size()) continue;
      if (!frames[f - 1].Saw(i) || !frames[f + 1].Saw(i)) continue;
      sums[1] +=
          smoothness *
          (place(f - 1, i) - 2 * place(f, i) + place(f + 1, i)).squaredNorm();
      counts[1] += 3;
    }
  }
  return {std::sqrt(sums[0] / counts[0]), std::sqrt(sums[1] / counts[1])};
}

TEST_F(HiddenMotionsAndCeres, GiveTheSameDeviations) {
  HiddenMotionOptions options;
  options.samples = 60;
  const auto [arap, smooth] = SeenResiduals(poses_, options.smoothness, model_);
  ASSERT_GT(arap, 1e-4);
  ASSERT_GT(smooth, 1e-3);
  RefineHiddenMotions(poses_, options, &model_);
  const std::vector<HiddenDeviation> found =
      HiddenDeviations(poses_, options, model_);
  const std::vector<double> expected =
      CeresReference(poses_, options.smoothness, model_)
          .Deviations(arap, smooth);
  ASSERT_EQ(found.size(), expected.size());
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_FALSE(model_.history.Find(found[i].frame)->Saw(found[i].node));
    EXPECT_NEAR(found[i].sigma / expected[i], 1, 0.3)
        << found[i].frame << " " << found[i].node;
    sum += found[i].sigma / expected[i];
  }
  EXPECT_NEAR(sum / static_cast<double>(found.size()), 1, 0.05);
}

TEST_F(HiddenMotionsAndCeres, DeviationsDoNotDependOnThreads) {
  HiddenMotionOptions options;
  options.samples = 3;
  RefineHiddenMotions(poses_, options, &model_);
  std::vector<HiddenDeviation> found[2];
  for (const int threads : {1, 4}) {
    const tbb::global_control limit(
        tbb::global_control::max_allowed_parallelism, threads);
    found[threads / 4] = HiddenDeviations(poses_, options, model_);
  }
  ASSERT_EQ(found[0].size(), found[1].size());
  ASSERT_FALSE(found[0].empty());
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    EXPECT_EQ(found[0][i].sigma, found[1][i].sigma);
  }
  options.samples = 0;
  EXPECT_TRUE(HiddenDeviations(poses_, options, model_).empty());
}

}  // namespace
}  // namespace splitfusion
