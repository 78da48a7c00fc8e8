#include "splitfusion/lib/experiment/solver_trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/expect_input_error.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A solve that took a second to begin, and one an iteration.
SolverTrial Trial(const std::string& setting, const std::vector<double>& costs,
                  const std::string& termination = "CONVERGENCE") {
  SolverTrial trial;
  trial.problem = "a";
  trial.setting = setting;
  trial.start = "warm";
  trial.report.usable = true;
  trial.report.termination = termination;
  trial.report.initial_cost = costs.front();
  trial.report.final_cost = costs.back();
  trial.report.total_seconds = double(costs.size());
  for (std::size_t i = 0; i < costs.size(); ++i) {
    SolverIteration iteration;
    iteration.iteration = int(i);
    iteration.cost = costs[i];
    iteration.seconds = i == 0 ? 0 : 1;
    trial.report.iterations.push_back(iteration);
  }
  return trial;
}

TEST(SolverTrials, AreJudgedByTheLeastCostOfTheirStart) {
  std::vector<SolverTrial> trials = {
      Trial("fast", {11, 1.001, 1}), Trial("slow", {11, 6, 1.05, 1.0001, 1}),
      Trial("elsewhere", {11, 3, 2}), Trial("cut", {11, 8}, "NO_CONVERGENCE"),
      Trial("broken", {11, 11}, "FAILURE")};
  trials[4].report.usable = false;
  JudgeTrials(&trials);
  EXPECT_EQ(trials[0].status, "converged");
  EXPECT_EQ(trials[1].status, "converged");
  EXPECT_EQ(trials[2].status, "other_minimum");
  EXPECT_EQ(trials[3].status, "no_convergence");
  EXPECT_EQ(trials[4].status, "failed");
  // One second to begin, then one an iteration; f_0 - f* is 10.
  EXPECT_DOUBLE_EQ(trials[0].seconds_to[0], 2);
  EXPECT_DOUBLE_EQ(trials[0].seconds_to[1], 2);
  EXPECT_DOUBLE_EQ(trials[0].seconds_to[2], 3);
  EXPECT_DOUBLE_EQ(trials[1].seconds_to[0], 3);
  EXPECT_DOUBLE_EQ(trials[1].seconds_to[1], 4);
  EXPECT_DOUBLE_EQ(trials[1].seconds_to[2], 5);
  for (const int other : {2, 3, 4}) {
    EXPECT_TRUE(std::isnan(trials[other].seconds_to[0])) << other;
  }
}

TEST(SolverTrials, ACostThatIsNotTakenIsNotReached) {
  std::vector<SolverTrial> trials = {Trial("a", {11, 0.5, 1})};
  trials[0].report.iterations[1].accepted = false;
  JudgeTrials(&trials);
  EXPECT_DOUBLE_EQ(trials[0].seconds_to[0], 3);
}

TEST(SolverTrials, ProfilesCountWhatIsSolved) {
  std::vector<SolverTrial> trials = {Trial("fast", {11, 1}),
                                     Trial("slow", {11, 6, 5, 1})};
  SolverTrial other = Trial("fast", {11, 2}, "NO_CONVERGENCE");
  other.problem = "b";
  trials.push_back(other);
  other = Trial("slow", {11, 1});
  other.problem = "b";
  trials.push_back(other);
  JudgeTrials(&trials);
  const CurveChart chart = PerformanceProfile(trials, 0);
  ASSERT_EQ(chart.curves.size(), 2u);
  EXPECT_EQ(chart.curves[0].name, "fast");
  // Half of the problems, as the fastest; the other one never.
  EXPECT_EQ(chart.curves[0].points[1], std::make_pair(1.0, 0.5));
  EXPECT_EQ(chart.curves[0].points.back().second, 0.5);
  // The fastest of one, and twice as slow on the other.
  EXPECT_EQ(chart.curves[1].points[1], std::make_pair(1.0, 0.5));
  EXPECT_EQ(chart.curves[1].points[2], std::make_pair(2.0, 1.0));
}

TEST(SolverTrials, GapsAreMeansOverProblems) {
  std::vector<SolverTrial> trials = {Trial("a", {101, 2, 1}),
                                     Trial("a", {101, 1})};
  trials[1].problem = "b";
  JudgeTrials(&trials);
  const CurveChart chart = GapOverIterations(trials);
  ASSERT_EQ(chart.curves.size(), 1u);
  ASSERT_EQ(chart.curves[0].points.size(), 3u);
  EXPECT_DOUBLE_EQ(chart.curves[0].points[0].second, 1);
  // 0.01 of the one, 1e-12 stands for 0 of the other.
  EXPECT_NEAR(chart.curves[0].points[1].second, std::sqrt(0.01 * 1e-12), 1e-12);
  EXPECT_NEAR(chart.curves[0].points[2].second, 1e-12, 1e-15);
  const CurveChart over_time = GapOverTime(trials);
  for (const auto& [seconds, gap] : over_time.curves[0].points) {
    EXPECT_TRUE(seconds >= 1 || gap == 1) << seconds << " s: " << gap;
  }
}

TEST(SolverSetting, IsMadeOfChoicesInAnyOrder) {
  const SolverSetting setting = ParseSolverSetting(
      "ceres:identity:cgnr", SolverOptions(), BuiltinSolvers());
  EXPECT_EQ(setting.options.solver, "ceres");
  EXPECT_EQ(setting.options.linear_solver, "cgnr");
  EXPECT_EQ(setting.options.preconditioner, "identity");
  EXPECT_EQ(setting.solver, "ceres:cgnr");
  EXPECT_EQ(setting.preconditioner, "identity");
  const auto parse = [](const std::string& text) {
    return ParseSolverSetting(text, SolverOptions(), BuiltinSolvers());
  };
  EXPECT_EQ(parse("gn_pcg").preconditioner, "jacobi");
  EXPECT_EQ(parse("gn_cholesky").preconditioner, "none");
  for (const std::string& name : BuiltinSolverSettings()) {
    EXPECT_NO_THROW(parse(name)) << name;
  }
  EXPECT_GE(BuiltinSolverSettings().size(), 12u);
  ExpectInputError([&] { parse("ceres:fast"); }, "'fast' is no choice");
  ExpectInputError([&] { parse("newton"); }, "solver = newton: expected");
  ExpectInputError([&] { parse("gn_pcg:dense_qr"); },
                   "linear_solver = dense_qr: expected auto, as it has no "
                   "effect but with solver ceres");
}

TEST(SolverTrials, AllSettingsFindTheMinimumOfAConvexProblem) {
  const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.02, 1);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const auto correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  const Energy energy =
      ParseEnergy("point_to_plane(loss=huber) arap(weight=3)", BuiltinTerms());
  const PinholeCamera camera;
  SurfaceProblem problem{energy, correspondences, camera};
  const std::vector<NodeMotion> before = graph.motions;
  problem.before = &before;
  Shake(0.003, /*seed=*/2, &graph);
  const FrozenProblem frozen = Freeze(problem, graph);
  SolverOptions base;
  base.max_iterations = 2000;
  base.function_tolerance = 1e-14;
  base.parameter_tolerance = 1e-12;
  for (const char* start : {"warm", "cold"}) {
    std::vector<SolverTrial> trials;
    for (const std::string& name : BuiltinSolverSettings()) {
      // Without a preconditioner, and without a Hessian, it takes too long.
      if (name == "ceres:nonlinear_cg" || name == "ceres:lbfgs") continue;
      trials.push_back(RunTrial(
          "p", frozen, ParseSolverSetting(name, base, BuiltinSolvers()),
          BuiltinSolvers(), {start, 1, 0}));
    }
    JudgeTrials(&trials);
    for (const SolverTrial& trial : trials) {
      EXPECT_EQ(trial.status, "converged") << start << " " << trial.setting;
      EXPECT_NEAR(trial.report.final_cost, trials[0].report.final_cost,
                  1e-8 * trials[0].report.final_cost)
          << start << " " << trial.setting;
    }
    EXPECT_EQ(TrialsTable(trials).rows.size(), trials.size());
  }
}

}  // namespace
}  // namespace splitfusion
