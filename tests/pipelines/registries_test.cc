// What the options may name, and what somebody adds to it.

#include "splitfusion/pipelines/registries.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/pipelines/split_fusion.h"
#include "support/expect_input_error.h"
#include "support/rejected.h"

namespace splitfusion {
namespace {

/// Gradient descent, each parameter in units of its own curvature; the step is
/// halved until the cost falls.
class Descent : public Solver {
 public:
  explicit Descent(const SolverOptions& options) : options_(options) {}

  SolverReport Minimize(const SurfaceProblem& input,
                        DeformationGraph* graph) const override {
    BlockProblem problem(input, *graph);
    BorderedMatrix matrix = problem.MakeMatrix();
    std::vector<double> twists(kTwistSize * graph->size(), 0.0);
    BorderedVector gradient;
    SolverReport report;
    report.message = "descent";
    problem.Evaluate(twists, /*with_jacobians=*/true);
    report.initial_cost = report.final_cost = problem.Cost();
    for (int i = 0; i < options_.max_iterations; ++i) {
      problem.Evaluate(twists, /*with_jacobians=*/true);
      problem.Assemble(&matrix, &gradient);
      for (double length = 1; length > 1e-3; length /= 2) {
        std::vector<double> moved = twists;
        for (std::size_t k = 0; k < moved.size(); ++k) {
          const int node = static_cast<int>(k / kTwistSize);
          const int d = static_cast<int>(k % kTwistSize);
          moved[k] -= length * gradient.nodes[node][d] /
                      matrix.nodes.Diagonal(node)(d, d);
        }
        problem.Evaluate(moved, /*with_jacobians=*/false);
        if (problem.Cost() >= report.final_cost) continue;
        report.final_cost = problem.Cost();
        twists = moved;
        break;
      }
    }
    report.usable = true;
    ComposeTwists(twists, graph);
    return report;
  }

 private:
  SolverOptions options_;
};

struct TrackedCorner {
  bool succeeded = false;
  double error = 0;  ///< Metres.
  SurfaceReport report;
};

/// The corner of a room, tracked by what the options and registries say.
TrackedCorner TrackCorner(const std::string& association,
                          const std::string& solver, int iterations,
                          const Registries& registries) {
  const Rigid3d motion = MakeMotion({0.01, -0.01, 0.01}, {0.02, -0.01, 0.02});
  TrackerOptions options;
  options.association = association;
  SolverOptions solver_options;
  solver_options.solver = solver;
  solver_options.max_iterations = iterations;
  const SurfaceTracker tracker(
      options, solver_options,
      ParseEnergy("point_to_plane(loss=tukey,scale=0.03)", registries.terms),
      registries.associations, registries.solvers);
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  TrackedCorner tracked;
  tracked.succeeded =
      tracker.Track(SamplesOf(View(CornerDepth(Rigid3d::Identity()))), {},
                    View(CornerDepth(motion)), 0, Rigid3d::Identity(), &graph,
                    &tracked.report);
  tracked.error =
      (MeanRigidMotion(graph).translation() - motion.translation()).norm();
  return tracked;
}

TEST(Registries, ASolverOfOnesOwnTracks) {
  Registries registries;
  registries.solvers.Register("descent", [](const SolverOptions& options) {
    return std::make_unique<Descent>(options);
  });
  const TrackedCorner tracked =
      TrackCorner("projective", "descent", 40, registries);
  EXPECT_TRUE(tracked.succeeded) << tracked.report.reason;
  EXPECT_EQ(tracked.report.rounds.back().solver.message, "descent");
  EXPECT_LT(tracked.error, 0.003);
  ExpectInputError([] { TrackCorner("projective", "descent", 1, {}); },
                   "solver = descent: expected gn_pcg, gn_cholesky or ceres");
}

TEST(Registries, EveryAssociationTracks) {
  for (const std::string& name : BuiltinAssociations().names()) {
    const TrackedCorner tracked = TrackCorner(name, "gn_pcg", 1, {});
    EXPECT_TRUE(tracked.succeeded) << name;
    EXPECT_LT(tracked.error, 0.001) << name;
  }
  ExpectInputError([] { TrackCorner("optical_flow", "gn_pcg", 1, {}); },
                   "association = optical_flow: expected projective or "
                   "closest_point");
}

TEST(Registries, AnAssociationOfOnesOwnHasItsOwnReasons) {
  /// Rejects every point.
  class Nothing : public Associator {
   public:
    Association Associate(const std::vector<ModelSample>& samples,
                          const WarpField&, int,
                          const AssociationGates&) const override {
      const int count = static_cast<int>(samples.size());
      return {{}, {count, 0, {{"not_in_the_mood", Rejection::kUntold, count}}}};
    }
  };
  Registries registries;
  registries.associations.Register("nothing",
                                   [](const LiveView&, std::uint16_t) {
                                     return std::make_unique<Nothing>();
                                   });
  const TrackedCorner tracked = TrackCorner("nothing", "gn_pcg", 1, registries);
  EXPECT_FALSE(tracked.succeeded);
  const AssociationCounts& counts = tracked.report.rounds.back().association;
  EXPECT_EQ(Rejected(counts, "not_in_the_mood"), counts.model_points);
}

TEST(Registries, ThePipelineTakesThem) {
  Registries registries;
  registries.solvers.Register("descent", [](const SolverOptions& options) {
    return std::make_unique<Descent>(options);
  });
  PipelineOptions options;
  options.solver.solver = "descent";
  options.split_scene = false;
  SplitFusion fusion(Camera(), options, LabelTable(), nullptr, registries);
  for (int i = 0; i < 3; ++i) {
    Frame frame;
    frame.index = i;
    frame.depth = CornerDepth(MakeMotion({0, 0, 0}, {0.005 * i, 0, 0}));
    frame.color = PlainColor(Camera(), {90, 90, 90});
    const FrameReport report = fusion.ProcessFrame(frame);
    EXPECT_EQ(report.surfaces.at(0).event, i == 0 ? "born" : "");
    EXPECT_EQ(report.surfaces.at(0).state, TrackState::kTracked);
  }
  ExpectInputError(
      [&] { SplitFusion(Camera(), options, LabelTable(), nullptr); },
      "solver = descent");
}

}  // namespace
}  // namespace splitfusion
