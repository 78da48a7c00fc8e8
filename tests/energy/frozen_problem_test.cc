#include "splitfusion/lib/energy/frozen_problem.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/frame/live_view.h"
#include "support/expect_input_error.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// A term that looks at the live frame, which is not kept.
class LiveTerm : public EnergyTerm {
 public:
  struct Constant {
    static constexpr int kResiduals = 1;
    double value;
    template <typename T>
    bool operator()(const T* x, T* residual) const {
      residual[0] = T(value) * x[2];
      return true;
    }
  };

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    sink->AddWarpedPoints(
        std::vector<const ModelSample*>{&input.correspondences[0].model},
        std::vector<Constant>{{input.live == nullptr ? 0.0 : 1.0}});
  }
};

class FrozenProblemTest : public ::testing::Test {
 protected:
  FrozenProblemTest() {
    Shake(0.005, /*seed=*/1, &graph_);
    correspondences_ = PerfectAssociation(
        mesh_, graph_,
        [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
    for (std::size_t i = 0; i < correspondences_.size(); ++i) {
      correspondences_[i].weight = 0.3f + 0.01f * float(i % 7);
      correspondences_[i].pixel = {100 + float(i), 50};
      correspondences_[i].intensity_difference = 0.01f * float(i % 5);
      correspondences_[i].intensity_gradient = {0.02f, -0.01f};
      correspondences_[i].model_intensity = 0.2f + 0.1f * float(i % 6);
    }
    lost_.assign(correspondences_.begin(), correspondences_.begin() + 5);
    tracks_.resize(4);
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].model = correspondences_[9 * i].model;
      tracks_[i].target = correspondences_[9 * i].target;
    }
    before_ = PlateGraph().motions;
    before_.resize(graph_.size());
  }

  SurfaceProblem Problem(const Energy& energy) const {
    SurfaceProblem problem{energy, correspondences_, camera_};
    problem.before = &before_;
    problem.anneal = 3;
    problem.initial_radius = 100;
    problem.lost = &lost_;
    problem.tracks = &tracks_;
    problem.surface = 7;
    return problem;
  }

  std::string Written(const FrozenProblem& problem) const {
    WriteFrozenProblem(folder_ / "p.h5", problem);
    return folder_ / "p.h5";
  }

  const TemporaryFolder folder_;
  const Energy energy_ = ParseEnergy(
      "point_to_plane(loss=tukey,scale=0.05) color(weight=2,metres=0.07) "
      "live_to_model(loss=huber) tracks(weight=3) arap(weight=3) "
      "temporal_arap(weight=2)",
      BuiltinTerms());
  const TriangleMesh mesh_ = PlateMesh(0.2, 0.1, 0.02, 1);
  PinholeCamera camera_{640, 480, 525, 525, 319.5, 239.5};
  DeformationGraph graph_ = CoverWithNodes(mesh_, 0.04);
  std::vector<Correspondence> correspondences_, lost_;
  std::vector<TrackedPoint> tracks_;
  std::vector<NodeMotion> before_;
};

TEST_F(FrozenProblemTest, FileHoldsTheProblemBitForBit) {
  FrozenProblem frozen = Freeze(Problem(energy_), graph_);
  frozen.frame = 12;
  frozen.solver = "gn_pcg";
  frozen.final_cost = 0.25;
  const FrozenProblem read = ReadFrozenProblem(Written(frozen), BuiltinTerms());
  EXPECT_EQ(read.frame, 12);
  EXPECT_EQ(read.surface, 7);
  EXPECT_EQ(read.solver, "gn_pcg");
  EXPECT_EQ(read.final_cost, 0.25);
  EXPECT_EQ(read.initial_radius, 100);
  EXPECT_EQ(EnergyText(read.energy), EnergyText(energy_));
  EXPECT_EQ(read.graph.neighbors, graph_.neighbors);
  EXPECT_EQ(read.start.cost, frozen.start.cost);
  // Every term has something to say here.
  for (const double cost : read.start.terms) EXPECT_GT(cost, 0);
  const ProblemStart start = EvaluateStart(read.View(), read.graph);
  EXPECT_EQ(start.cost, frozen.start.cost);
  EXPECT_EQ(start.terms, frozen.start.terms);
  EXPECT_EQ(start.gradient, frozen.start.gradient);
}

TEST_F(FrozenProblemTest, IsSolvedAsTheProblemItself) {
  const FrozenProblem read = ReadFrozenProblem(
      Written(Freeze(Problem(energy_), graph_)), BuiltinTerms());
  for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
    SolverOptions options;
    options.solver = solver;
    options.max_iterations = 10;
    DeformationGraph own = graph_, replayed = read.graph;
    Minimize(Problem(energy_), options, &own);
    Minimize(read.View(), options, &replayed);
    EXPECT_EQ(std::memcmp(own.motions.data(), replayed.motions.data(),
                          own.motions.size() * sizeof(NodeMotion)),
              0)
        << solver;
  }
}

TEST_F(FrozenProblemTest, KeepsTheUnknownsOfTerms) {
  const Energy energy = ParseEnergy(
      "point_to_plane color(weight=2,exposure=true) arap", BuiltinTerms());
  SurfaceProblem problem = Problem(energy);
  EXPECT_EQ(Freeze(problem, graph_).unknowns, (std::vector<double>{1, 0}));
  problem.unknowns = {1.25, -0.125};
  const FrozenProblem frozen = Freeze(problem, graph_);
  const FrozenProblem read = ReadFrozenProblem(Written(frozen), BuiltinTerms());
  EXPECT_EQ(read.unknowns, problem.unknowns);
  EXPECT_EQ(read.start.by_unknowns, frozen.start.by_unknowns);
  const ProblemStart start = EvaluateStart(read.View(), read.graph);
  EXPECT_EQ(start.cost, frozen.start.cost);
  EXPECT_EQ(start.by_unknowns, frozen.start.by_unknowns);
  EXPECT_NE(start.by_unknowns[0], 0);
  SolverOptions options;
  DeformationGraph own = graph_, replayed = read.graph;
  const SolverReport report = Minimize(problem, options, &own);
  const SolverReport replay = Minimize(read.View(), options, &replayed);
  EXPECT_EQ(report.final_cost, replay.final_cost);
  EXPECT_EQ(report.unknowns[0].final, replay.unknowns[0].final);
  FrozenProblem bad = frozen;
  bad.unknowns.pop_back();
  bad.start.by_unknowns.pop_back();
  ExpectInputError([&] { ReadFrozenProblem(Written(bad), BuiltinTerms()); },
                   "p.h5: unknowns/start: expected one of each of 2 unknowns");
}

TEST_F(FrozenProblemTest, WhatIsNotThereStaysAway) {
  SurfaceProblem problem{energy_, correspondences_, camera_};
  const FrozenProblem read =
      ReadFrozenProblem(Written(Freeze(problem, graph_)), BuiltinTerms());
  EXPECT_EQ(read.View().before, nullptr);
  EXPECT_EQ(read.View().lost, nullptr);
  EXPECT_EQ(read.View().tracks, nullptr);
}

TEST_F(FrozenProblemTest, TermsThatLookAtTheLiveFrameAreRefused) {
  TermRegistry terms = BuiltinTerms();
  terms.Register("live", [] { return std::make_unique<LiveTerm>(); });
  const Energy energy = ParseEnergy("point_to_plane live", terms);
  const LiveView live;
  SurfaceProblem problem = Problem(energy);
  problem.live = &live;
  ExpectInputError([&] { Freeze(problem, graph_); },
                   "term 'live' looks at the live frame");
}

TEST_F(FrozenProblemTest, RefusesContentThatCannotBe) {
  const FrozenProblem good = Freeze(Problem(energy_), graph_);
  const auto expect = [&](const FrozenProblem& bad, const std::string& what) {
    ExpectInputError([&] { ReadFrozenProblem(Written(bad), BuiltinTerms()); },
                     "p.h5: " + what);
  };
  FrozenProblem bad = good;
  bad.correspondences[2].model.skinning.nodes[0] = 1000000;
  expect(bad, "correspondences/nodes: expected ascending ones of ");
  bad = good;
  (*bad.tracks)[1].model.skinning.count = 9;
  expect(bad, "tracks/node_count: expected 1..8");
  bad = good;
  bad.graph.neighbors[0][0] = -1;
  expect(bad, "edges/nodes: 0, -1: expected two of ");
  bad = good;
  bad.before->pop_back();
  expect(bad, "before: expected a motion of each of ");
  bad = good;
  bad.start.terms.pop_back();
  expect(bad, "terms/start_cost: expected one of each of 6 terms");
  bad = good;
  bad.camera.fx = 0;
  expect(bad, "camera fx = 0");
  bad = good;
  bad.correspondences[0].target.x() = std::nanf("");
  expect(bad, "dataset correspondences/target has a number that is not finite");
  ExpectInputError(
      [&] { ReadFrozenProblem(Written(good), TermRegistry("term")); },
      "p.h5: term = point_to_plane");
}

TEST_F(FrozenProblemTest, DamageNeverCrashes) {
  const std::string path = Written(Freeze(Problem(energy_), graph_));
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  for (std::size_t at = 5; at < bytes.size(); at += 97) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(~damaged[at]);
    const std::string other = folder_.Write("damaged.h5", damaged);
    try {
      const FrozenProblem read = ReadFrozenProblem(other, BuiltinTerms());
      EvaluateStart(read.View(), read.graph);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace splitfusion
