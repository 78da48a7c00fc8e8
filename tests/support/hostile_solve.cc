#include "support/hostile_solve.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/twist.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

bool SameBytes(const DeformationGraph& a, const DeformationGraph& b) {
  return std::memcmp(a.motions.data(), b.motions.data(),
                     a.motions.size() * sizeof(NodeMotion)) == 0;
}

void ExpectFinite(const DeformationGraph& graph) {
  for (const NodeMotion& motion : graph.motions) {
    EXPECT_TRUE(motion.rotation.allFinite());
    EXPECT_TRUE(motion.translation.allFinite());
    EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-9);
  }
}

/// Solves of one case.
class HostileSolve {
 public:
  explicit HostileSolve(const HostileCase& hostile) : case_(hostile) {
    energy_ = ParseEnergy("point_to_plane arap(weight=3)", BuiltinTerms());
    energy_.push_back({case_.options, case_.term});
  }

  void ExpectEnd(const SolverOptions& options) {
    SCOPED_TRACE(options.solver + " " + options.minimizer);
    for (const bool rigid : {false, true}) {
      SCOPED_TRACE(rigid ? "rigid" : "non-rigid");
      SetSurface(rigid);
      const End end = case_.end;
      if (end == End::kRefused || end == End::kThrows) {
        ExpectRefused(options);
      } else {
        ExpectEnds(options);
      }
    }
  }

 private:
  /// The plate, which has gone 2 cm away, and its pairs.
  void SetSurface(bool rigid) {
    start_ = rigid ? MakeRigidGraph(Rigid3d::Identity())
                   : CoverWithNodes(mesh_, 0.04);
    pairs_ = PerfectAssociation(mesh_, start_, [](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(p.x(), p.y(), p.z() + 0.02);
    });
  }

  SurfaceProblem Problem() const {
    SurfaceProblem problem{energy_, pairs_, camera_};
    problem.unknowns = case_.start;
    return problem;
  }

  void ExpectRefused(const SolverOptions& options) {
    DeformationGraph graph = start_;
    const bool input_error = case_.end == End::kRefused;
    try {
      Minimize(Problem(), options, &graph);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const InputError& error) {
      EXPECT_TRUE(input_error);
      EXPECT_THAT(error.what(), HasSubstr(case_.text));
    } catch (const std::exception& error) {
      EXPECT_FALSE(input_error);
      EXPECT_THAT(error.what(), HasSubstr(case_.text));
    } catch (...) {
      ADD_FAILURE() << "what was thrown is no std::exception";
    }
    EXPECT_TRUE(SameBytes(graph, start_));
  }

  void ExpectEnds(const SolverOptions& options) {
    const End end = case_.end;
    DeformationGraph graph = start_;
    const SolverReport report = Minimize(Problem(), options, &graph);
    const bool fails = report.termination == "FAILURE";
    EXPECT_EQ(report.usable, !fails) << report.message;
    if (end != End::kStays) {
      EXPECT_EQ(fails, end == End::kFails) << report.message;
    }
    EXPECT_THAT(report.message, HasSubstr(case_.text));
    if (end != End::kFinite) {
      EXPECT_EQ(SameBytes(graph, start_), end != End::kSolved);
    }
    ExpectFinite(graph);
    EXPECT_EQ(report.parameters, kTwistSize * graph.size() +
                                     static_cast<int>(report.unknowns.size()));
    ASSERT_EQ(report.terms.size(), 3u);
    EXPECT_EQ(report.terms[2].term, "hostile");
    EXPECT_TRUE(std::isfinite(report.terms[0].initial));
    if (end == End::kFails || end == End::kStays) return;
    for (const TermCost& term : report.terms) {
      EXPECT_TRUE(std::isfinite(term.initial + term.final)) << term.term;
    }
    for (const UnknownEstimate& unknown : report.unknowns) {
      EXPECT_TRUE(std::isfinite(unknown.final)) << unknown.name;
    }
    EXPECT_LE(report.final_cost, report.initial_cost);
  }

  const HostileCase& case_;
  const TriangleMesh mesh_ = PlateMesh(0.2, 0.1, 0.02, 1);
  const PinholeCamera camera_{640, 480, 525, 525, 319.5, 239.5};
  Energy energy_;
  DeformationGraph start_;
  std::vector<Correspondence> pairs_;
};

}  // namespace

Unknown Named(const std::string& name, double initial, double scale) {
  return {name, "", initial, scale};
}

TermOptions Weight(double weight) { return {"hostile", weight}; }

TermOptions Loss(LossKind loss, double scale) {
  return {"hostile", 1, loss, scale};
}

std::shared_ptr<HostileTerm> Adding(Add add) {
  auto term = std::make_shared<HostileTerm>();
  term->add = std::move(add);
  return term;
}

std::shared_ptr<HostileTerm> WithUnknowns(std::vector<Unknown> unknowns,
                                          Add add) {
  auto term = Adding(std::move(add));
  term->unknowns = [unknowns = std::move(unknowns)] { return unknowns; };
  return term;
}

std::shared_ptr<HostileTerm> Points(Fault fault) {
  return Adding([fault](const EnergyInput& input, ResidualSink* sink) {
    const auto samples = ModelSamplesOf(input);
    sink->AddWarpedPoints(samples,
                          std::vector<SpoiledPoint>(samples.size(), {fault}));
  });
}

std::shared_ptr<HostileTerm> OnePoint(Fault fault) {
  return Adding([fault](const EnergyInput& input, ResidualSink* sink) {
    const auto samples = ModelSamplesOf(input);
    std::vector<SpoiledPoint> functors(samples.size());
    functors.back().fault = fault;
    sink->AddWarpedPoints(samples, functors);
  });
}

std::shared_ptr<HostileTerm> Nodes(Fault fault) {
  return Adding([fault](const EnergyInput& input, ResidualSink* sink) {
    std::vector<std::vector<int>> nodes;
    for (int i = 0; i < input.graph.size(); ++i) nodes.push_back({i});
    sink->AddNodes(nodes, std::vector<SpoiledNode>(nodes.size(), {fault}));
  });
}

std::shared_ptr<HostileTerm> Gains(Fault of_points, Fault of_prior,
                                   const Unknown& unknown) {
  return WithUnknowns(
      {unknown}, [=](const EnergyInput& input, ResidualSink* sink) {
        const auto samples = ModelSamplesOf(input);
        sink->AddWarpedPoints(
            samples, std::vector<SpoiledGain>(samples.size(), {of_points}));
        sink->AddUnknowns(std::vector<SpoiledPrior>{{of_prior}});
      });
}

void PrintTo(const HostileCase& hostile, std::ostream* out) {
  *out << hostile.name;
}

std::string NameOf(const ::testing::TestParamInfo<HostileCase>& info) {
  return info.param.name;
}

void ExpectEnd(const HostileCase& hostile) {
  SolverOptions options;
  options.max_iterations = 4;
  for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
    options.solver = solver;
    HostileSolve(hostile).ExpectEnd(options);
  }
  options.threads = 2;
  HostileSolve(hostile).ExpectEnd(options);
}

}  // namespace splitfusion
