// Whole runs with every solver. Each frame builds on the one before, and a
// difference in the last digits of a step grows; that no two solvers differ
// after some frames says more than that they find the same minimum.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sf_run_fixture.h"

namespace splitfusion {
namespace {

using nlohmann::json;

class SolverRuns : public SfRun {
 protected:
  void RunWith(const std::string& output, const std::string& solver) const {
    const ProgramResult result =
        Run(output, solver +
                        " --keep_radius=false"
                        " --pictures_every=0 --warped_every=0");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  std::string Trajectory(const std::string& output) const {
    return folder_.Read(output + "/trajectory.txt");
  }

  /// Nodes and vertices of all surfaces.
  std::vector<int> Sizes(const std::string& output) const {
    std::vector<int> sizes;
    const json summary = json::parse(folder_.Read(output + "/summary.json"));
    for (const json& surface : summary.at("surfaces")) {
      sizes.push_back(surface.at("nodes").get<int>());
      sizes.push_back(surface.at("vertices").get<int>());
    }
    return sizes;
  }
};

TEST_F(SolverRuns, AreTheSameWhereStepsAreAsAccurate) {
  // Every round has the first radius: Ceres' falls after a step that brings
  // less than was predicted, that of the others only after one that is not
  // taken.
  Synthesize("--frames=6");  // Then the person, of few pixels, is lost once.
  RunWith("cholesky", "--solver=gn_cholesky");
  RunWith("ceres", "--solver=ceres");
  RunWith("pcg", "--solver=gn_pcg --eta=1e-15 --linear_iterations=2000");
  RunWith("default", "--solver=gn_pcg");
  EXPECT_GE(Sizes("cholesky").size(), 4u);  // The room and a person at least.
  for (const char* other : {"ceres", "pcg"}) {
    SCOPED_TRACE(other);
    EXPECT_EQ(Trajectory(other), Trajectory("cholesky"));
    EXPECT_EQ(Sizes(other), Sizes("cholesky"));
  }
  // To the default accuracy they are not.
  EXPECT_NE(Sizes("default"), Sizes("cholesky"));
}

}  // namespace
}  // namespace splitfusion
