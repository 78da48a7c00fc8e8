#include "splitfusion/lib/energy/solver.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

Energy ParsedEnergy(const std::string& text) {
  return ParseEnergy(text, BuiltinTerms());
}

SolverOptions Thorough() {
  SolverOptions options;
  options.max_iterations = 50;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  return options;
}

/// Associates with the true places and minimises, a few times.
SolverReport Fit(const TriangleMesh& mesh, const Map& truth,
                 const Energy& energy, const SolverOptions& options,
                 DeformationGraph* graph) {
  SolverReport report;
  for (int round = 0; round < 8; ++round) {
    const auto correspondences = PerfectAssociation(mesh, *graph, truth);
    report =
        Minimize({energy, correspondences, PinholeCamera()}, options, graph);
  }
  return report;
}

/// Mean distance of warped vertices to where they should be, metres.
double MeanError(const std::vector<Eigen::Vector3f>& vertices, const Map& truth,
                 const DeformationGraph& graph) {
  const SkinningIndex index(graph, 6);
  const WarpField warp(graph);
  double sum = 0;
  for (const Eigen::Vector3f& v : vertices) {
    const Eigen::Vector3d x = warp.WarpPoint(index.Skin(v), v).cast<double>();
    sum += (x - truth(v.cast<double>())).norm();
  }
  return sum / static_cast<double>(vertices.size());
}

bool SameBytes(const DeformationGraph& a, const DeformationGraph& b) {
  return a.motions.size() == b.motions.size() &&
         std::memcmp(a.motions.data(), b.motions.data(),
                     a.motions.size() * sizeof(NodeMotion)) == 0;
}

TEST(Solver, RecoversARigidMotion) {
  const TriangleMesh mesh = CornerMesh(0.02);
  const Rigid3d truth = MakeMotion({0.1, -0.15, 0.2}, {0.05, -0.03, 0.1});
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const SolverReport report = Fit(
      mesh, [&](const Eigen::Vector3d& p) { return truth * p; },
      ParsedEnergy("point_to_plane"), SolverOptions(), &graph);
  EXPECT_TRUE(report.usable);
  const Rigid3d error = MeanRigidMotion(graph).inverse() * truth;
  EXPECT_LT(error.translation().norm(), 1e-5);
  EXPECT_LT(RotationAngle(error.linear()), 1e-5);
  EXPECT_EQ(report.parameters, 6);
}

TEST(Solver, RecoversABend) {
  // The plate z = 1 is rolled up; the walls beside it hold it in its place.
  const TriangleMesh mesh = CornerMesh(0.01);
  const auto bend = [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); };
  std::vector<Eigen::Vector3f> plate;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    if (v.z() > 0.999f) plate.push_back(v);
  }
  DeformationGraph graph = CoverWithNodes(mesh, 0.03);
  EXPECT_GT(MeanError(plate, bend, graph), 6e-3);
  Fit(mesh, bend, ParsedEnergy("point_to_plane(weight=1) arap(weight=0.1)"),
      SolverOptions(), &graph);
  EXPECT_LT(MeanError(plate, bend, graph), 1.5e-3);
}

TEST(Solver, AStiffPriorKeepsThePlateRigid) {
  const TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  const auto bend = [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.5); };
  const auto deformation = [&](const std::string& terms) {
    DeformationGraph graph = CoverWithNodes(mesh, 0.04);
    Fit(mesh, bend, ParsedEnergy(terms), SolverOptions(), &graph);
    const Rigid3d mean = MeanRigidMotion(graph);
    double largest = 0;
    for (int i = 0; i < graph.size(); ++i) {
      const Eigen::Vector3d& g = graph.positions[i];
      largest = std::max(largest,
                         (g + graph.motions[i].translation - mean * g).norm());
    }
    return largest;
  };
  EXPECT_LT(deformation("point_to_plane arap(weight=1e6)"), 1e-3);
  EXPECT_GT(deformation("point_to_plane arap(weight=0.1)"), 1e-2);
}

struct Choice {
  const char* solver;
  const char* linear_solver;
  const char* preconditioner;
  const char* trust_region;
};
/// A term of one's own over points: where every fifth should be, metres.
struct Anchor {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d place;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d] - T(place[d]);
    return true;
  }
};

/// And one over node triples: the middle stays between the others.
struct Straight {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d bend;  ///< Of the centres, metres.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(bend[d]) + twists[0][3 + d] -
                    T(0.5) * (twists[1][3 + d] + twists[2][3 + d]);
    }
    return true;
  }
};

class CustomTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    std::vector<Anchor> anchors;
    for (std::size_t i = 0; i < input.correspondences.size(); i += 5) {
      samples.push_back(&input.correspondences[i].model);
      anchors.push_back({input.correspondences[i].target.cast<double>()});
    }
    sink->AddWarpedPoints(samples, anchors);
    std::vector<std::vector<int>> nodes;
    std::vector<Straight> bends;
    const auto center = [&](int i) -> Eigen::Vector3d {
      return input.graph.positions[i] + input.graph.motions[i].translation;
    };
    for (int i = 2; i < input.graph.size(); ++i) {
      nodes.push_back({i - 1, i, i - 2});
      bends.push_back({center(i - 1) - 0.5 * (center(i) + center(i - 2))});
    }
    sink->AddNodes(nodes, bends);
  }
};

Energy EnergyWithCustomTerm() {
  TermRegistry terms = BuiltinTerms();
  terms.Register("custom", [] { return std::make_unique<CustomTerm>(); });
  return ParseEnergy(
      "point_to_plane(loss=huber) arap(weight=3) "
      "custom(weight=0.01,loss=cauchy,scale=0.05)",
      terms);
}

class EverySolver : public ::testing::TestWithParam<Choice> {};

TEST_P(EverySolver, FindsTheSameMinimum) {
  const TriangleMesh mesh = CornerMesh(0.02);
  const DeformationGraph start = CoverWithNodes(mesh, 0.04);
  const auto correspondences = PerfectAssociation(
      mesh, start, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  const Energy energy = EnergyWithCustomTerm();
  const SurfaceProblem problem{energy, correspondences, PinholeCamera()};
  DeformationGraph reference = start;
  const double cost =
      MinimizeWithCeres(problem, Thorough(), &reference).final_cost;
  SolverOptions options = Thorough();
  options.solver = GetParam().solver;
  options.linear_solver = GetParam().linear_solver;
  options.preconditioner = GetParam().preconditioner;
  options.trust_region = GetParam().trust_region;
  options.eta = 1e-6;
  options.max_linear_solver_iterations = 1000;
  options.Check();
  DeformationGraph graph = start;
  const SolverReport report = Minimize(problem, options, &graph);
  EXPECT_TRUE(report.usable);
  EXPECT_EQ(report.termination, "CONVERGENCE");
  EXPECT_NEAR(report.final_cost, cost, 1e-6 * cost);
  const bool direct = options.solver != std::string("gn_pcg");
  EXPECT_LE(report.iterations.back().linear_residual, direct ? 1e-9 : 1e-6);
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_LT((graph.motions[i].translation - reference.motions[i].translation)
                  .norm(),
              1e-5);
  }
}

constexpr char kLm[] = "levenberg_marquardt";
INSTANTIATE_TEST_SUITE_P(
    Names, EverySolver,
    ::testing::Values(
        Choice{"gn_pcg", "auto", "jacobi", kLm},
        Choice{"gn_pcg", "auto", "identity", kLm},
        Choice{"gn_pcg", "auto", "block_ic0", kLm},
        Choice{"gn_cholesky", "auto", "jacobi", kLm},
        Choice{"ceres", "auto", "jacobi", kLm},
        Choice{"ceres", "dense_qr", "jacobi", kLm},
        Choice{"ceres", "dense_normal_cholesky", "jacobi", kLm},
        Choice{"ceres", "sparse_normal_cholesky", "jacobi", kLm},
        Choice{"ceres", "cgnr", "jacobi", kLm},
        Choice{"ceres", "cgnr", "identity", kLm},
        Choice{"ceres", "auto", "jacobi", "dogleg"},
        Choice{"ceres", "dense_qr", "jacobi", "dogleg"},
        Choice{"ceres", "dense_normal_cholesky", "jacobi", "dogleg"},
        Choice{"ceres", "sparse_normal_cholesky", "jacobi", "dogleg"}),
    [](const auto& info) {
      return std::string(info.param.solver) + "_" + info.param.linear_solver +
             "_" + info.param.preconditioner + "_" + info.param.trust_region;
    });

class BentPlateProblem : public ::testing::TestWithParam<const char*> {
 protected:
  BentPlateProblem() : start_(CoverWithNodes(mesh_, 0.04)) {
    Shake(0.005, /*seed=*/1, &start_);
    correspondences_ = PerfectAssociation(
        mesh_, start_,
        [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  }

  /// Minimises with the solver under test.
  SolverReport Run(SolverOptions options, DeformationGraph* graph,
                   double prior_factor = 1) const {
    options.solver = GetParam();
    return Minimize({energy_, correspondences_, PinholeCamera(), prior_factor},
                    options, graph);
  }

  const TriangleMesh mesh_ = PlateMesh(0.2, 0.1, 0.02, 1);
  const Energy energy_ =
      ParsedEnergy("point_to_plane(loss=tukey,scale=0.05) arap(weight=3)");
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

TEST_P(BentPlateProblem, AnnealingCountsForThePriorAlone) {
  DeformationGraph graph = start_;
  const SolverReport plain = Run(SolverOptions(), &graph);
  graph = start_;
  const SolverReport annealed = Run(SolverOptions(), &graph, 8);
  EXPECT_NEAR(annealed.terms[0].initial, plain.terms[0].initial, 1e-12);
  EXPECT_NEAR(annealed.terms[1].initial, 8 * plain.terms[1].initial,
              1e-9 * annealed.terms[1].initial);
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
  const SolverReport report = Run(Thorough(), &graph);
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

INSTANTIATE_TEST_SUITE_P(Solvers, BentPlateProblem,
                         ::testing::Values("ceres", "gn_pcg", "gn_cholesky"));

TEST(Solver, FullReportComesOnRequest) {
  const TriangleMesh mesh = CornerMesh(0.05);
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const auto correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return p; });
  SolverOptions options;
  options.full_report = true;
  const SolverReport report = MinimizeWithCeres(
      {ParsedEnergy("point_to_plane"), correspondences, PinholeCamera()},
      options, &graph);
  EXPECT_NE(report.full_report.find("Solver Summary"), std::string::npos);
}

TEST(Solver, AnEmptyProblemChangesNothing) {
  const Energy energy = ParsedEnergy("point_to_plane arap");
  const DeformationGraph before =
      MakeRigidGraph(MakeMotion({0.1, 0, 0}, {0, 0, 1}));
  for (const char* solver : {"ceres", "gn_pcg", "gn_cholesky"}) {
    SolverOptions options;
    options.solver = solver;
    DeformationGraph graph = before;
    const SolverReport report =
        Minimize({energy, {}, PinholeCamera()}, options, &graph);
    EXPECT_EQ(report.final_cost, 0);
    EXPECT_LT((graph.motions[0].rotation - before.motions[0].rotation).norm(),
              1e-12);
    EXPECT_EQ(graph.motions[0].translation, before.motions[0].translation);
  }
}

}  // namespace
}  // namespace splitfusion
