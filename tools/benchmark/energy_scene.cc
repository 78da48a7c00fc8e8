#include "energy_scene.h"

#include <tbb/task_arena.h>

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/deformation/surface_edges.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

constexpr double kSize = 0.8;    // Of the sheet, metres.
constexpr double kRadius = 0.3;  // Of its bend, metres.
constexpr int kNodesAcross = 20;

/// The built-in distance again, as a user would write it: a plain functor and a
/// small class (examples/02_custom_energy_term.cc).
struct UserPointToPlane {
  static constexpr int kResiduals = 1;
  Eigen::Vector3d normal;
  Eigen::Vector3d target;
  double root;

  template <typename T>
  bool operator()(const T* x, T* residual) const {
    T distance = T(0);
    for (int d = 0; d < 3; ++d) {
      distance += T(normal[d]) * (x[d] - T(target[d]));
    }
    residual[0] = T(root) * distance;
    return true;
  }
};

class UserTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    std::vector<UserPointToPlane> functors;
    for (const Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
      functors.push_back({c.warped_normal.cast<double>(),
                          c.target.cast<double>(), std::sqrt(c.weight)});
    }
    sink->AddWarpedPoints(samples, functors);
  }
};

/// Angle of the bend at `u` (metres along the sheet).
double Angle(double u) { return (u - kSize / 2) / kRadius; }

Eigen::Vector3d PointAt(double u, double v) {
  return {kRadius * std::sin(Angle(u)), v - kSize / 2,
          2 + kRadius * (1 - std::cos(Angle(u)))};
}

/// Where a point of the sheet has moved, metres.
Eigen::Vector3d Moved(const Eigen::Vector3d& p) {
  return p + 0.01 * Eigen::Vector3d(std::sin(3 * p.x() + p.y()),
                                    std::cos(4 * p.y()),
                                    1 + std::sin(5 * p.x() - p.y()));
}

constexpr double kStep = 0.01;  // Between vertices, metres.
constexpr int kColumns = 81;

TriangleMesh SheetMesh() {
  TriangleMesh mesh;
  for (int i = 0; i < kColumns * kColumns; ++i) {
    const int row = i / kColumns, column = i % kColumns;
    mesh.vertices.push_back(PointAt(kStep * column, kStep * row).cast<float>());
    if (row == 0 || column == 0) continue;
    mesh.triangles.emplace_back(i, i - kColumns, i - 1);
    mesh.triangles.emplace_back(i - 1, i - kColumns, i - kColumns - 1);
  }
  return mesh;
}

/// Nodes on a grid, each moved by up to a third of its cell.
DeformationGraph SheetGraph() {
  const TriangleMesh mesh = SheetMesh();
  DeformationGraph graph;
  graph.node_spacing = kSize / kNodesAcross;
  std::vector<NodeSeed> seeds;
  for (int i = 0; i < EnergyScene::kNodes; ++i) {
    const double u = graph.node_spacing *
                     (i % kNodesAcross + 0.2 + 0.6 * HashUnit(i, 0, 0, 1));
    const double v = graph.node_spacing *
                     (i / kNodesAcross + 0.2 + 0.6 * HashUnit(i, 0, 0, 2));
    const Eigen::Vector3d g = PointAt(u, v);
    const int vertex = static_cast<int>(kColumns * std::lround(v / kStep) +
                                        std::lround(u / kStep));
    seeds.push_back({vertex, (g.cast<float>() - mesh.vertices[vertex]).norm()});
    graph.positions.push_back(g);
  }
  graph.motions.resize(graph.positions.size());
  graph.neighbors = ConnectAlongSurface(graph.positions, seeds, mesh,
                                        GraphOptions().neighbors_per_node);
  return graph;
}

/// The i-th pair; row by row over the sheet, as an image is read, each at a
/// random place of its cell.
Correspondence MakeCorrespondence(const SkinningIndex& index, int i) {
  constexpr int kAcross = 200, kRows = EnergyScene::kPoints / kAcross;
  const double u = kSize / kAcross * (i % kAcross + HashUnit(i, 1, 0, 1));
  const double v = kSize / kRows * (i / kAcross + HashUnit(i, 1, 0, 2));
  const Eigen::Vector3d point = PointAt(u, v);
  const Eigen::Vector3f noise(HashUnit(i, 2, 0, 1), HashUnit(i, 2, 0, 2),
                              HashUnit(i, 2, 0, 3));
  Correspondence c;
  c.model.point = point.cast<float>();
  c.model.normal =
      Eigen::Vector3d(std::sin(Angle(u)), 0, -std::cos(Angle(u))).cast<float>();
  c.model.skinning = index.Skin(c.model.point);
  c.warped_normal = c.target_normal = c.model.normal;
  c.target = Moved(point).cast<float>() + 0.004f * noise;
  c.weight = 0.5f + 0.5f * HashUnit(i, 3, 0, 1);
  return c;
}

/// Levenberg-Marquardt damping as the solvers have it.
SymmetricBlockMatrix Damped(SymmetricBlockMatrix matrix, double radius) {
  for (int i = 0; i < matrix.size(); ++i) {
    const Vector6 diagonal = matrix.Diagonal(i).diagonal();
    matrix.Diagonal(i).diagonal() += diagonal.cwiseMax(1e-6) / radius;
  }
  return matrix;
}

std::vector<Vector6> Negative(std::vector<Vector6> values) {
  for (Vector6& v : values) v = -v;
  return values;
}

}  // namespace

EnergyScene::EnergyScene() : graph(SheetGraph()) {
  const SkinningIndex index(graph, kPointNodes);
  for (int i = 0; i < kPoints; ++i) {
    correspondences.push_back(MakeCorrespondence(index, i));
  }
}

Energy EnergyScene::MakeEnergy(bool custom) {
  TermRegistry terms = BuiltinTerms();
  terms.Register("user_term", [] { return std::make_unique<UserTerm>(); });
  const std::string data = custom ? "user_term" : "point_to_plane";
  return ParseEnergy(data + "(weight=1,loss=tukey,scale=0.03) arap(weight=8)",
                     terms);
}

SolverOptions EnergyScene::Options(const std::string& solver) {
  SolverOptions options;
  options.solver = solver;
  options.max_iterations = kIterations;
  options.function_tolerance = 0;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 0;
  return options;
}

SolverOptions EnergyScene::CeresOptions() {
  SolverOptions options = Options("ceres");
  options.linear_solver = "cgnr";
  options.threads = tbb::this_task_arena::max_concurrency();
  return options;
}

SurfaceProblem EnergyScene::Problem(const Energy& energy) const {
  return {energy, correspondences, camera};
}

MeasuredSystem::MeasuredSystem(const EnergyScene& scene)
    : twists(6 * scene.graph.size(), 0.0), matrix(0, {}), damped(0, {}) {
  const Energy energy = EnergyScene::MakeEnergy(/*custom=*/false);
  const SurfaceProblem problem = scene.Problem(energy);
  const SolverOptions options = EnergyScene::Options("gn_pcg");
  BlockProblem blocks(problem, scene.graph);
  matrix = blocks.MakeMatrix();
  radius = options.initial_radius;
  for (int i = 1;; ++i) {
    blocks.Evaluate(twists, /*with_jacobians=*/true);
    blocks.Assemble(&matrix, &gradient);
    damped = Damped(matrix, radius);
    solution =
        MakeLinearSolver(options)->Solve(damped, Negative(gradient), &step);
    if (i == EnergyScene::kIterations) return;
    for (int k = 0; k < 6 * scene.graph.size(); ++k) {
      twists[k] += step[k / 6][k % 6];
    }
    radius *= 3;
  }
}

}  // namespace splitfusion
