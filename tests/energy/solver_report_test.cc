// What every solver promises of its report and of the graph, whatever the
// problem: costs that add up, the same bytes again, nothing after a failure.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>
#include <limits>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/solver.h"
#include "support/custom_energy.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

bool SameBytes(const DeformationGraph& a, const DeformationGraph& b) {
  return a.motions.size() == b.motions.size() &&
         std::memcmp(a.motions.data(), b.motions.data(),
                     a.motions.size() * sizeof(NodeMotion)) == 0;
}

class BentPlateProblem : public ::testing::TestWithParam<const char*> {
 protected:
  BentPlateProblem() : start_(CoverWithNodes(mesh_, 0.04)) {
    Shake(0.005, /*seed=*/1, &start_);
    correspondences_ = PerfectAssociation(
        mesh_, start_,
        [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  }

  /// Minimises with the solver under test.
  SolverReport Run(SolverOptions options, DeformationGraph* graph) const {
    options.solver = GetParam();
    return Minimize({energy_, correspondences_, PinholeCamera()}, options,
                    graph);
  }

  const TriangleMesh mesh_ = PlateMesh(0.2, 0.1, 0.02, 1);
  const Energy energy_ = ParseEnergy(
      "point_to_plane(loss=tukey,scale=0.05) arap(weight=3)", BuiltinTerms());
  DeformationGraph start_;
  std::vector<Correspondence> correspondences_;
};

TEST_P(BentPlateProblem, ReportAccountsForTheCost) {
  DeformationGraph graph = start_;
  SolverOptions options;
  options.max_iterations = 5;
  const SolverReport report = Run(options, &graph);
  ASSERT_EQ(report.terms.size(), 2u);
  EXPECT_EQ(report.terms[0].term, "point_to_plane");
  EXPECT_EQ(report.terms[1].term, "arap");
  EXPECT_EQ(report.terms[0].residual_vectors,
            static_cast<int>(mesh_.vertices.size()));
  EXPECT_NEAR(report.terms[0].initial + report.terms[1].initial,
              report.initial_cost, 1e-9 * report.initial_cost);
  EXPECT_NEAR(report.terms[0].final + report.terms[1].final, report.final_cost,
              1e-9 * report.initial_cost);
  EXPECT_LT(report.final_cost, report.initial_cost);
  EXPECT_EQ(report.parameters, 6 * graph.size());
  ASSERT_GE(report.iterations.size(), 2u);
  EXPECT_EQ(report.iterations[0].iteration, 0);
  EXPECT_EQ(report.iterations[0].cost, report.initial_cost);
  for (const SolverIteration& iteration : report.iterations) {
    EXPECT_LE(iteration.cost, report.initial_cost);
    EXPECT_GT(iteration.trust_region_radius, 0);
  }
  EXPECT_TRUE(report.full_report.empty());
}

TEST_P(BentPlateProblem, AStepFromTheResultStartsAtItsCost) {
  // What the report says of the twists holds for the composed motions, too.
  DeformationGraph graph = start_;
  const SolverReport first = Run(SolverOptions(), &graph);
  const SolverReport second = Run(SolverOptions(), &graph);
  EXPECT_NEAR(second.initial_cost, first.final_cost, 1e-9 * first.final_cost);
}

TEST_P(BentPlateProblem, TwoRunsGiveTheSameBytes) {
  DeformationGraph first = start_, second = start_;
  Run(SolverOptions(), &first);
  const tbb::global_control one_thread(
      tbb::global_control::max_allowed_parallelism, 1);
  Run(SolverOptions(), &second);
  EXPECT_TRUE(SameBytes(first, second));
  EXPECT_FALSE(SameBytes(first, start_));
}

TEST_P(BentPlateProblem, AFailureLeavesTheGraphAsItWas) {
  correspondences_[3].target.x() = std::numeric_limits<float>::quiet_NaN();
  DeformationGraph graph = start_;
  const SolverReport report = Run(SolverOptions(), &graph);
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.termination, "FAILURE");
  EXPECT_FALSE(report.message.empty());
  EXPECT_TRUE(SameBytes(graph, start_));
}

TEST_P(BentPlateProblem, NodesWithoutAnyPointStayWhereThePriorHoldsThem) {
  correspondences_.resize(1);
  DeformationGraph graph = start_;
  SolverOptions options;
  options.max_iterations = 50;
  options.function_tolerance = options.parameter_tolerance = 1e-12;
  const SolverReport report = Run(options, &graph);
  EXPECT_TRUE(report.usable);
  for (const NodeMotion& motion : graph.motions) {
    EXPECT_TRUE(motion.translation.allFinite());
    EXPECT_LT(motion.translation.norm(), 0.3);
  }
}

TEST_P(BentPlateProblem, ThreadsDoNotChangeAByteOfALargerProblem) {
  const TriangleMesh mesh = CornerMesh(0.005);
  DeformationGraph graph = CoverWithNodes(mesh, 0.02);
  const auto correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  const Energy energy = EnergyWithCustomTerm();
  SolverOptions options;
  options.solver = GetParam();
  DeformationGraph results[2] = {graph, graph};
  for (const int threads : {1, 2}) {
    const tbb::global_control control(
        tbb::global_control::max_allowed_parallelism, threads);
    Minimize({energy, correspondences, PinholeCamera()}, options,
             &results[threads - 1]);
  }
  EXPECT_TRUE(SameBytes(results[0], results[1]));
  EXPECT_FALSE(SameBytes(results[0], graph));
}

TEST_P(BentPlateProblem, GradientsAreThoseAfterTheIteration) {
  // A second solve starts where the first one ended; by its twists the gradient
  // is a little another one.
  SolverOptions options;
  options.max_iterations = 3;
  DeformationGraph graph = start_;
  const SolverReport three = Run(options, &graph);
  options.max_iterations = 2;
  DeformationGraph other = start_;
  Run(options, &other);
  options.max_iterations = 1;
  const SolverReport next = Run(options, &other);
  ASSERT_EQ(three.iterations.size(), 4u);
  EXPECT_NEAR(three.iterations[2].gradient_max_norm,
              next.iterations[0].gradient_max_norm,
              0.1 * next.iterations[0].gradient_max_norm);
  EXPECT_LT(three.iterations[2].gradient_max_norm,
            0.5 * three.iterations[1].gradient_max_norm);
}

TEST_P(BentPlateProblem, CountsTheResidualsOfTheTerms) {
  DeformationGraph graph = start_;
  int edges = 0;
  for (const auto& neighbors : graph.neighbors) edges += int(neighbors.size());
  EXPECT_EQ(Run(SolverOptions(), &graph).residuals,
            int(correspondences_.size()) + 3 * edges);
}

TEST_P(BentPlateProblem, FullReportTellsSizesAndIterations) {
  DeformationGraph graph = start_;
  SolverOptions options;
  options.full_report = true;
  const std::string text = Run(options, &graph).full_report;
  for (const char* part :
       {"Solver Summary", "Parameters", "Residuals", "Cost", "Termination"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
}

TEST(DenseSolver, DoesNotBeginWhatDoesNotFit) {
  // The Jacobian alone would take hundreds of gigabytes.
  DeformationGraph graph = PlateGraph();
  graph.positions.resize(30000, Eigen::Vector3d(0, 0, 1));
  graph.motions.resize(30000);
  graph.neighbors.resize(30000);
  const Energy energy = ParseEnergy("arap", BuiltinTerms());
  SolverOptions options;
  options.solver = "ceres";
  options.linear_solver = "dense_qr";
  const SolverReport report =
      Minimize({energy, {}, PinholeCamera()}, options, &graph);
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.termination, "FAILURE");
  EXPECT_EQ(report.message.find("dense_qr needs "), 0u) << report.message;
}

INSTANTIATE_TEST_SUITE_P(Solvers, BentPlateProblem,
                         ::testing::Values("ceres", "gn_pcg", "gn_cholesky"));

}  // namespace
}  // namespace splitfusion
