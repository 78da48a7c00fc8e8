// Unknowns of the terms' own: every solver finds them with the motions.

#include "support/own_unknowns.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/gradient_check.h"
#include "splitfusion/lib/energy/term_unknowns.h"
#include "support/expect_input_error.h"
#include "support/sample_correspondences.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Options that go on to the very minimum.
SolverOptions Thorough(const std::string& solver) {
  SolverOptions options;
  options.solver = solver;
  options.max_iterations = 100;
  options.function_tolerance = 1e-15;
  options.parameter_tolerance = 1e-12;
  if (solver == "gn_pcg") {
    options.eta = 1e-6;
    options.max_linear_solver_iterations = 1000;
  }
  return options;
}

BrighterSurface RigidCorner() { return {CornerMesh(0.02), 0}; }
BrighterSurface Corner() { return {CornerMesh(0.02), 0.04}; }
/// Of some hundred nodes.
BrighterSurface WavySheet() {
  const auto waves = [](double x, double y) {
    return Eigen::Vector3d(x - 0.5, y - 0.4,
                           1 + 0.03 * std::sin(14 * x) * std::cos(16 * y));
  };
  return {SheetMesh(1.0, 0.8, 0.02, waves), 0.05};
}

SolverReport Solve(const BrighterSurface& surface, const SolverOptions& options,
                   std::vector<double> start = {}) {
  const Energy energy = EnergyWithUnknowns();
  SurfaceProblem problem = surface.Problem(energy);
  problem.unknowns = std::move(start);
  DeformationGraph graph = surface.graph;
  options.Check();
  return Minimize(problem, options, &graph);
}

void ExpectSameMinimum(const SolverReport& report,
                       const SolverReport& reference) {
  EXPECT_TRUE(report.usable);
  EXPECT_EQ(report.termination, "CONVERGENCE");
  EXPECT_EQ(report.parameters, reference.parameters);
  EXPECT_EQ(report.residuals, reference.residuals);
  EXPECT_NEAR(report.initial_cost, reference.initial_cost,
              1e-12 * reference.initial_cost);
  EXPECT_NEAR(report.final_cost, reference.final_cost,
              1e-8 * reference.final_cost);
  ASSERT_EQ(report.unknowns.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(report.unknowns[i].name, reference.unknowns[i].name);
    EXPECT_EQ(report.unknowns[i].initial, reference.unknowns[i].initial);
    EXPECT_NEAR(report.unknowns[i].final, reference.unknowns[i].final, 1e-5);
  }
}

TEST(OwnUnknowns, AllSolversFindCeresMinimum) {
  for (const BrighterSurface& surface : {RigidCorner(), Corner()}) {
    SCOPED_TRACE(surface.graph.size());
    const SolverReport reference = Solve(surface, Thorough("ceres"));
    EXPECT_LT(reference.final_cost, 0.5 * reference.initial_cost);
    EXPECT_EQ(reference.parameters, 6 * surface.graph.size() + 3);
    for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
      SCOPED_TRACE(solver);
      ExpectSameMinimum(Solve(surface, Thorough(solver)), reference);
    }
    SolverOptions options = Thorough("gn_pcg");
    options.preconditioner = "identity";
    ExpectSameMinimum(Solve(surface, options), reference);
    for (const char* linear : {"dense_qr", "dense_normal_cholesky",
                               "sparse_normal_cholesky", "cgnr"}) {
      SCOPED_TRACE(linear);
      options = Thorough("ceres");
      options.linear_solver = linear;
      if (options.linear_solver == "cgnr") {
        options.eta = 1e-6;
        options.max_linear_solver_iterations = 1000;
      }
      ExpectSameMinimum(Solve(surface, options), reference);
    }
  }
}

TEST(OwnUnknowns, SoDoOurSolversOnHundredsOfNodes) {
  const BrighterSurface surface = WavySheet();
  ASSERT_GT(surface.graph.size(), 200);
  const SolverReport reference = Solve(surface, Thorough("ceres"));
  for (const char* solver : {"gn_pcg", "gn_cholesky"}) {
    SCOPED_TRACE(solver);
    ExpectSameMinimum(Solve(surface, Thorough(solver)), reference);
  }
}

TEST(OwnUnknowns, TheReportTellsWhatBecameOfThem) {
  const SolverReport report = Solve(Corner(), Thorough("gn_pcg"));
  ASSERT_EQ(report.unknowns.size(), 3u);
  EXPECT_EQ(report.unknowns[0].term, "color");
  EXPECT_EQ(report.unknowns[0].name, "gain");
  EXPECT_EQ(report.unknowns[0].initial, 1);
  EXPECT_NEAR(report.unknowns[0].final, BrighterSurface::kGain, 0.02);
  EXPECT_EQ(report.unknowns[1].unit, "grey value");
  EXPECT_EQ(report.unknowns[1].initial, 0);
  EXPECT_NEAR(report.unknowns[1].final, BrighterSurface::kOffset, 0.02);
  EXPECT_EQ(report.unknowns[2].term, "depth_scale");
  // Taken up where a solve before has left them, nothing is left to do.
  std::vector<double> reached;
  for (const UnknownEstimate& unknown : report.unknowns) {
    reached.push_back(unknown.final);
  }
  const SolverReport next = Solve(Corner(), Thorough("gn_pcg"), reached);
  EXPECT_LT(next.initial_cost, report.initial_cost);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(next.unknowns[i].initial, reached[i]);
    EXPECT_NEAR(next.unknowns[i].final, reached[i], 1e-5);
  }
}

TEST(OwnUnknowns, DoNotDependOnTheNumberOfThreads) {
  const BrighterSurface surface = WavySheet();
  const Energy energy = EnergyWithUnknowns();
  for (const char* solver : {"gn_pcg", "gn_cholesky"}) {
    SolverOptions options;
    options.solver = solver;
    options.max_iterations = 5;
    std::vector<DeformationGraph> graphs;
    std::vector<double> gains;
    for (const int threads : {1, 4}) {
      const tbb::global_control limit(
          tbb::global_control::max_allowed_parallelism, threads);
      graphs.push_back(surface.graph);
      gains.push_back(Minimize(surface.Problem(energy), options, &graphs.back())
                          .unknowns[0]
                          .final);
    }
    EXPECT_EQ(gains[0], gains[1]) << solver;
    EXPECT_EQ(std::memcmp(graphs[0].motions.data(), graphs[1].motions.data(),
                          graphs[0].motions.size() * sizeof(NodeMotion)),
              0)
        << solver;
  }
}

TEST(OwnUnknowns, OnesThatNothingDependsOnStay) {
  const BrighterSurface surface = Corner();
  const Energy energy =
      ParseEnergy("point_to_plane color(weight=0,exposure=true) arap",
                  TermsWithDepthScale());
  for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
    SurfaceProblem problem = surface.Problem(energy);
    problem.unknowns = {1.25, 0.5};
    DeformationGraph graph = surface.graph;
    const SolverReport report = Minimize(problem, Thorough(solver), &graph);
    EXPECT_TRUE(report.usable) << solver;
    EXPECT_EQ(report.unknowns[0].final, 1.25) << solver;
    EXPECT_EQ(report.unknowns[1].final, 0.5) << solver;
  }
}

TEST(OwnUnknowns, StartsMustBeOfTheTerms) {
  const BrighterSurface surface = RigidCorner();
  ExpectInputError(
      [&] {
        Solve(surface, Thorough("gn_pcg"), {1, 0});
      },
      "unknowns = 2: expected 3, as the terms declare");
}

/// A term whose functor and whose list of unknowns can be wrong.
class FaultyTerm : public EnergyTerm {
 public:
  explicit FaultyTerm(std::vector<Unknown> unknowns, bool forgets = false)
      : unknowns_(std::move(unknowns)), forgets_(forgets) {}

  /// Forgets to differentiate by its unknown.
  struct Functor {
    static constexpr int kResiduals = 1;
    static constexpr int kUnknowns = 1;
    bool forgets;
    bool operator()(const double* x, const double* unknowns,
                    double* residual) const {
      residual[0] = x[2] - 1.01 + 0.1 * unknowns[0];
      return true;
    }
    template <typename T>
    bool operator()(const T* x, const T* unknowns, T* residual) const {
      residual[0] = x[2] - T(1.01) +
                    (forgets ? T(0.1 * unknowns[0].a) : 0.1 * unknowns[0]);
      return true;
    }
  };

  std::vector<Unknown> Unknowns() const override { return unknowns_; }
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    for (const Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
    }
    sink->AddWarpedPoints(samples,
                          std::vector<Functor>(samples.size(), {forgets_}));
  }

 private:
  std::vector<Unknown> unknowns_;
  bool forgets_;
};

Energy FaultyEnergy(const std::vector<Unknown>& unknowns,
                    bool forgets = false) {
  TermOptions options;
  options.name = "faulty";
  return {{options, std::make_shared<FaultyTerm>(unknowns, forgets)}};
}

TEST(OwnUnknowns, ForgottenDerivativesByThemShow) {
  const BrighterSurface surface = Corner();
  for (const GradientError& error :
       CheckGradients(surface.Problem(EnergyWithUnknowns()), surface.graph)) {
    EXPECT_LT(error.relative, 1e-6) << error.term;
    EXPECT_EQ(error.failed, 0) << error.term;
  }
  for (const bool forgets : {false, true}) {
    const Energy energy = FaultyEnergy({{"u", "", 0.5}}, forgets);
    const GradientError error =
        CheckGradients(surface.Problem(energy), surface.graph).front();
    EXPECT_EQ(error.failed, 0);
    if (forgets) {
      EXPECT_GT(error.relative, 0.1);
    } else {
      EXPECT_LT(error.relative, 1e-6);
    }
  }
}

TEST(OwnUnknowns, FaultyDeclarationsAreRefused) {
  const BrighterSurface surface = RigidCorner();
  const Energy none = FaultyEnergy({});
  ExpectInputError(
      [&] { BlockProblem(surface.Problem(none), surface.graph); },
      "unknowns of a functor of term 'faulty' = 1: expected 0, as the term "
      "declares");
  const auto refused = [](const std::vector<Unknown>& unknowns,
                          const std::string& message) {
    ExpectInputError([&] { CheckEnergy(FaultyEnergy(unknowns)); }, message);
  };
  CheckEnergy(FaultyEnergy({{"u", "", 0}, {"v", "", 0}}));
  refused({{"u", "", 0}, {"u", "", 0}}, "unknown of a term = faulty.u");
  refused({{"u v", "", 0}}, "unknown of a term = u v: expected letters");
  refused({{"u", "", std::nan("")}}, "initial of unknown faulty.u = nan");
  refused({{"u", "", 0, 0}},
          "scale of unknown faulty.u = 0: expected a number above 0");
}

}  // namespace
}  // namespace splitfusion
