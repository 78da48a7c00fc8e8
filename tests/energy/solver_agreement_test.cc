// Every solver against Ceres by default, on a problem with a user's term.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "splitfusion/lib/energy/solver.h"
#include "support/custom_energy.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

SolverOptions Thorough() {
  SolverOptions options;
  options.max_iterations = 50;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  return options;
}

struct Choice {
  const char* solver;
  const char* linear_solver;
  const char* preconditioner;
  const char* trust_region;
};

class EverySolver : public ::testing::TestWithParam<Choice> {};

TEST_P(EverySolver, FindsTheSameMinimum) {
  const TriangleMesh mesh = CornerMesh(0.02);
  const DeformationGraph start = CoverWithNodes(mesh, 0.04);
  const auto correspondences = PerfectAssociation(
      mesh, start, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  const Energy energy = EnergyWithCustomTerm();
  const SurfaceProblem problem{energy, correspondences, PinholeCamera()};
  DeformationGraph reference = start;
  SolverOptions options = Thorough();
  options.solver = "ceres";
  const double cost = Minimize(problem, options, &reference).final_cost;
  options.solver = GetParam().solver;
  options.linear_solver = GetParam().linear_solver;
  options.preconditioner = GetParam().preconditioner;
  options.trust_region = GetParam().trust_region;
  const bool direct = options.solver != "gn_pcg";
  if (!direct || options.linear_solver == "cgnr") {
    options.eta = 1e-6;
    options.max_linear_solver_iterations = 1000;
  }
  options.Check();
  DeformationGraph graph = start;
  const SolverReport report = Minimize(problem, options, &graph);
  EXPECT_TRUE(report.usable);
  EXPECT_EQ(report.termination, "CONVERGENCE");
  EXPECT_NEAR(report.final_cost, cost, 1e-6 * cost);
  EXPECT_LE(report.iterations.back().linear_residual, direct ? 1e-9 : 1e-6);
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_LT((graph.motions[i].translation - reference.motions[i].translation)
                  .norm(),
              1e-5);
  }
}

TEST(Orderings, LeadToTheSameMinimum) {
  const TriangleMesh mesh = CornerMesh(0.02);
  const DeformationGraph start = CoverWithNodes(mesh, 0.04);
  const auto correspondences = PerfectAssociation(
      mesh, start, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  const Energy energy = EnergyWithCustomTerm();
  const SurfaceProblem problem{energy, correspondences, PinholeCamera()};
  double least = 0;
  for (const char* solver : {"ceres", "gn_cholesky"}) {
    for (const char* ordering : {"amd", "nesdis", "natural"}) {
      SCOPED_TRACE(std::string(solver) + " " + ordering);
      SolverOptions options = Thorough();
      options.solver = solver;
      options.ordering = ordering;
      options.Check();
      DeformationGraph graph = start;
      const SolverReport report = Minimize(problem, options, &graph);
      EXPECT_EQ(report.termination, "CONVERGENCE");
      if (least == 0) least = report.final_cost;
      EXPECT_NEAR(report.final_cost, least, 1e-8 * least);
    }
  }
}

TEST(GnCholesky, StepsAreThoseOfCeresHoweverSmall) {
  const TriangleMesh mesh = CornerMesh(0.02);
  const Energy energy = EnergyWithCustomTerm();
  SolverOptions options;         // One iteration per association.
  options.initial_radius = 1e4;  // The less damped, the less is left to do.
  DeformationGraph expected = CoverWithNodes(mesh, 0.04), graph = expected;
  for (int round = 0; round < 12; ++round) {
    // The further, the less is left to be done.
    const double bend = 1 - std::pow(0.1, 1 + round / 3);
    const auto correspondences = PerfectAssociation(
        mesh, expected,
        [&](const Eigen::Vector3d& p) { return Bend(p, 1, bend); });
    const SurfaceProblem problem{energy, correspondences, PinholeCamera()};
    options.solver = "ceres";
    Minimize(problem, options, &expected);
    options.solver = "gn_cholesky";
    const SolverReport report = Minimize(problem, options, &graph);
    EXPECT_TRUE(report.iterations.back().accepted) << round;
    for (int i = 0; i < graph.size(); ++i) {
      EXPECT_LT((graph.motions[i].translation - expected.motions[i].translation)
                    .norm(),
                1e-7)
          << "round " << round << ", node " << i;
    }
  }
}

constexpr char kLm[] = "levenberg_marquardt";
INSTANTIATE_TEST_SUITE_P(
    Names, EverySolver,
    ::testing::Values(
        Choice{"gn_pcg", "auto", "auto", kLm},
        Choice{"gn_pcg", "auto", "jacobi", kLm},
        Choice{"gn_pcg", "auto", "identity", kLm},
        Choice{"gn_cholesky", "auto", "auto", kLm},
        Choice{"ceres", "auto", "auto", kLm},
        Choice{"ceres", "dense_qr", "auto", kLm},
        Choice{"ceres", "dense_normal_cholesky", "auto", kLm},
        Choice{"ceres", "sparse_normal_cholesky", "auto", kLm},
        Choice{"ceres", "cgnr", "auto", kLm},
        Choice{"ceres", "cgnr", "jacobi", kLm},
        Choice{"ceres", "cgnr", "identity", kLm},
        Choice{"ceres", "auto", "auto", "dogleg"},
        Choice{"ceres", "dense_qr", "auto", "dogleg"},
        Choice{"ceres", "dense_normal_cholesky", "auto", "dogleg"},
        Choice{"ceres", "sparse_normal_cholesky", "auto", "dogleg"},
        Choice{"ceres", "auto", "auto", "subspace_dogleg"}),
    [](const auto& info) {
      return std::string(info.param.solver) + "_" + info.param.linear_solver +
             "_" + info.param.preconditioner + "_" + info.param.trust_region;
    });

}  // namespace
}  // namespace splitfusion
