#include "splitfusion/lib/energy/solution_recorder.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

class SolutionRecorderTest : public ::testing::Test {
 protected:
  SolutionRecorderTest() {
    const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.02, 1);
    graph_ = CoverWithNodes(mesh, 0.04);
    correspondences_ = PerfectAssociation(
        mesh, graph_, [](const Eigen::Vector3d& p) { return Bend(p, 1, 1.0); });
  }

  /// Solves as surface `id` with a recorded solver.
  void Solve(int id, DeformationGraph* graph) const {
    SurfaceProblem problem{energy_, correspondences_, camera_};
    problem.surface = id;
    solvers_.Make("gn_pcg", SolverOptions())->Minimize(problem, graph);
  }

  const Energy energy_ = ParseEnergy("point_to_plane arap", BuiltinTerms());
  const PinholeCamera camera_;
  DeformationGraph graph_;
  std::vector<Correspondence> correspondences_;
  std::shared_ptr<SolutionRecorder> recorder_ =
      std::make_shared<SolutionRecorder>(5);
  SolverRegistry solvers_ = recorder_->Watch(BuiltinSolvers());
};

TEST_F(SolutionRecorderTest, SolversAreWhatTheyWere) {
  EXPECT_EQ(solvers_.names(), BuiltinSolvers().names());
  DeformationGraph watched = graph_, alone = graph_;
  recorder_->BeginFrame(0);
  Solve(1, &watched);
  Minimize({energy_, correspondences_, camera_}, SolverOptions(), &alone);
  for (int i = 0; i < graph_.size(); ++i) {
    EXPECT_EQ(watched.motions[i].translation, alone.motions[i].translation);
  }
}

TEST_F(SolutionRecorderTest, KeepsTheLastSolutionOfEverySurface) {
  recorder_->BeginFrame(10);
  DeformationGraph graph = graph_, other = graph_;
  Solve(1, &graph);
  Solve(1, &graph);
  Solve(4, &other);
  ASSERT_NE(recorder_->Find(1), nullptr);
  ASSERT_NE(recorder_->Find(4), nullptr);
  EXPECT_EQ(recorder_->Find(2), nullptr);
  EXPECT_EQ(recorder_->Find(1)->problem.graph.motions[3].translation,
            graph.motions[3].translation);
  const SurfaceProblem view = recorder_->Find(4)->View();
  EXPECT_EQ(view.surface, 4);
  EXPECT_EQ(view.correspondences.size(), correspondences_.size());
  EXPECT_EQ(view.live, nullptr);
}

TEST_F(SolutionRecorderTest, KeepsOneFrameOfSoMany) {
  recorder_->BeginFrame(5);
  Solve(1, &graph_);
  EXPECT_NE(recorder_->Find(1), nullptr);
  recorder_->BeginFrame(6);
  EXPECT_EQ(recorder_->Find(1), nullptr);
  Solve(1, &graph_);
  EXPECT_EQ(recorder_->Find(1), nullptr);
}

}  // namespace
}  // namespace splitfusion
