// What a surface is after it was fitted.

#include "splitfusion/lib/energy/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

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

TEST(Solver, FullReportComesOnRequest) {
  const TriangleMesh mesh = CornerMesh(0.05);
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const auto correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return p; });
  SolverOptions options;
  options.solver = "ceres";
  options.full_report = true;
  const SolverReport report = Minimize(
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
