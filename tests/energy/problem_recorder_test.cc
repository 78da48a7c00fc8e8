#include "splitfusion/lib/energy/problem_recorder.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/trial_surface.h"
#include "splitfusion/lib/frame/live_view.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

class ProblemRecorderTest : public ::testing::Test {
 protected:
  ProblemRecorderTest() {
    const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.02, 1);
    graph_ = CoverWithNodes(mesh, 0.04);
    correspondences_ = PerfectAssociation(
        mesh, graph_, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  }

  /// Solves as surface `id` with a recorded solver.
  SolverReport Solve(int id, DeformationGraph* graph) const {
    SurfaceProblem problem{energy_, correspondences_, camera_};
    problem.surface = id;
    return solvers_.Make("gn_pcg", SolverOptions())->Minimize(problem, graph);
  }

  std::vector<FrozenProblem> Recorded() {
    std::vector<FrozenProblem> problems;
    first_.clear();
    recorder_->EndFrame(
        [&](const FrozenProblem& problem, bool first) {
          (first ? first_ : problems).push_back(problem);
        },
        [](int, const std::string& reason) { ADD_FAILURE() << reason; });
    return problems;
  }

  std::vector<FrozenProblem> first_;  // As Recorded() has them.
  const Energy energy_ = ParseEnergy("point_to_plane arap", BuiltinTerms());
  const PinholeCamera camera_;
  DeformationGraph graph_;
  std::vector<Correspondence> correspondences_;
  std::shared_ptr<ProblemRecorder> recorder_ =
      std::make_shared<ProblemRecorder>(5);
  SolverRegistry solvers_ = recorder_->Watch(BuiltinSolvers());
};

TEST_F(ProblemRecorderTest, SolversAreWhatTheyWere) {
  EXPECT_EQ(solvers_.names(), BuiltinSolvers().names());
  DeformationGraph watched = graph_, alone = graph_;
  recorder_->BeginFrame(0);
  const SolverReport report = Solve(1, &watched);
  Minimize({energy_, correspondences_, camera_}, SolverOptions(), &alone);
  EXPECT_GT(report.initial_cost, report.final_cost);
  for (int i = 0; i < graph_.size(); ++i) {
    EXPECT_EQ(watched.motions[i].translation, alone.motions[i].translation);
  }
}

TEST_F(ProblemRecorderTest, KeepsTheLastSolveOfEverySurface) {
  recorder_->BeginFrame(10);
  DeformationGraph graph = graph_, other = graph_;
  Solve(1, &graph);
  const DeformationGraph second = graph;
  const SolverReport report = Solve(1, &graph);
  Solve(4, &other);
  Solve(kTrialSurface, &other);  // What is only compared is kept by nobody.
  const std::vector<FrozenProblem> problems = Recorded();
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].frame, 10);
  EXPECT_EQ(problems[0].surface, 1);
  EXPECT_EQ(problems[0].solver, "gn_pcg");
  EXPECT_EQ(problems[0].start.cost, report.initial_cost);
  EXPECT_EQ(problems[0].final_cost, report.final_cost);
  EXPECT_EQ(problems[0].graph.motions[3].translation,
            second.motions[3].translation);
  EXPECT_EQ(problems[1].surface, 4);
  ASSERT_EQ(first_.size(), 2u);
  EXPECT_EQ(first_[0].graph.motions[3].translation,
            graph_.motions[3].translation);
  EXPECT_EQ(first_[1].start.cost, problems[1].start.cost);
}

TEST_F(ProblemRecorderTest, OtherFramesAreNotRecorded) {
  DeformationGraph graph = graph_;
  recorder_->BeginFrame(5);
  Solve(1, &graph);
  recorder_->BeginFrame(6);
  Solve(1, &graph);
  EXPECT_TRUE(Recorded().empty());
}

/// Looks at the live frame where there is one.
class LiveTerm : public EnergyTerm {
 public:
  struct Pull {
    static constexpr int kResiduals = 1;
    template <typename T>
    bool operator()(T const* const* twists, T* residual) const {
      residual[0] = twists[0][3] + T(1);
      return true;
    }
  };
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.live != nullptr) sink->AddNodes({{0}}, std::vector<Pull>(1));
  }
};

TEST_F(ProblemRecorderTest, OfASurfaceThatIsRefusedNothingIsKept) {
  TermRegistry terms = BuiltinTerms();
  terms.Register("live", [] { return std::make_unique<LiveTerm>(); });
  const Energy energy = ParseEnergy("point_to_plane arap live", terms);
  const LiveView live;
  SurfaceProblem problem{energy, correspondences_, camera_};
  problem.surface = 1;
  const auto solver = solvers_.Make("gn_pcg", SolverOptions());
  recorder_->BeginFrame(5);
  DeformationGraph graph = graph_;
  solver->Minimize(problem, &graph);
  problem.live = &live;
  solver->Minimize(problem, &graph);
  problem.surface = 2;
  problem.live = nullptr;
  solver->Minimize(problem, &graph);
  std::vector<int> kept;
  std::vector<int> refused;
  recorder_->EndFrame(
      [&](const FrozenProblem& frozen, bool) {
        kept.push_back(frozen.surface);
      },
      [&](int surface, const std::string&) { refused.push_back(surface); });
  EXPECT_EQ(kept, (std::vector<int>{2, 2}));
  EXPECT_EQ(refused, std::vector<int>{1});
}

}  // namespace
}  // namespace splitfusion
