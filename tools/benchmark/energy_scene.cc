#include "energy_scene.h"

#include <tbb/task_arena.h>

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/deformation/graph_growth.h"
#include "splitfusion/lib/deformation/surface_edges.h"
#include "splitfusion/lib/energy/block_problem.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

constexpr double kSpacing = 0.04;  // Of the nodes, metres.
constexpr double kBend = 8 / 3.0;  // Angle of the whole bend, radians.
constexpr double kStep = 0.01;     // Between vertices, metres.

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
    double total = 0;
    for (const Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
      functors.push_back({c.warped_normal.cast<double>(),
                          c.target.cast<double>(), std::sqrt(c.weight)});
      total += c.weight;
    }
    sink->AddWarpedPoints(samples, functors, total);
  }
};

/// Cells of a sheet, as nearly as many across as down.
struct Cells {
  explicit Cells(int count) {
    rows = static_cast<int>(std::sqrt(count));
    while (count % rows != 0) --rows;
    across = count / rows;
  }

  int across;
  int rows;
};

/// The sheet; u and v are metres along it.
struct Sheet {
  explicit Sheet(int nodes)
      : cells(nodes),
        width(kSpacing * cells.across),
        height(kSpacing * cells.rows),
        radius(width / kBend) {}

  /// Angle of the bend at `u`.
  double Angle(double u) const { return (u - width / 2) / radius; }

  Eigen::Vector3d PointAt(double u, double v) const {
    return {radius * std::sin(Angle(u)), v - height / 2,
            2 + radius * (1 - std::cos(Angle(u)))};
  }

  Eigen::Vector3d NormalAt(double u) const {
    return {std::sin(Angle(u)), 0, -std::cos(Angle(u))};
  }

  Cells cells;  // One a node.
  double width;
  double height;
  double radius;  // Of the bend.
};

/// Where a point of the sheet has moved, metres.
Eigen::Vector3d Moved(const Eigen::Vector3d& p) {
  return p + 0.01 * Eigen::Vector3d(std::sin(3 * p.x() + p.y()),
                                    std::cos(4 * p.y()),
                                    1 + std::sin(5 * p.x() - p.y()));
}

/// Vertices along a length.
int Columns(double length) {
  return static_cast<int>(std::lround(length / kStep)) + 1;
}

TriangleMesh SheetMesh(const Sheet& sheet) {
  const int columns = Columns(sheet.width);
  TriangleMesh mesh;
  for (int i = 0; i < columns * Columns(sheet.height); ++i) {
    const int row = i / columns, column = i % columns;
    mesh.vertices.push_back(
        sheet.PointAt(kStep * column, kStep * row).cast<float>());
    if (row == 0 || column == 0) continue;
    mesh.triangles.emplace_back(i, i - columns, i - 1);
    mesh.triangles.emplace_back(i - 1, i - columns, i - columns - 1);
  }
  return mesh;
}

/// Nodes on a grid, each moved by up to a third of its cell.
DeformationGraph SheetGraph(const Sheet& sheet) {
  const TriangleMesh mesh = SheetMesh(sheet);
  DeformationGraph graph;
  graph.node_spacing = kSpacing;
  std::vector<NodeSeed> seeds;
  for (int i = 0; i < sheet.cells.across * sheet.cells.rows; ++i) {
    const double u =
        kSpacing * (i % sheet.cells.across + 0.2 + 0.6 * HashUnit(i, 0, 0, 1));
    const double v =
        kSpacing * (i / sheet.cells.across + 0.2 + 0.6 * HashUnit(i, 0, 0, 2));
    const Eigen::Vector3d g = sheet.PointAt(u, v);
    const int vertex = static_cast<int>(
        Columns(sheet.width) * std::lround(v / kStep) + std::lround(u / kStep));
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
Correspondence MakeCorrespondence(const Sheet& sheet, const Cells& cells,
                                  const SkinningIndex& index, int i) {
  const double u =
      sheet.width / cells.across * (i % cells.across + HashUnit(i, 1, 0, 1));
  const double v =
      sheet.height / cells.rows * (i / cells.across + HashUnit(i, 1, 0, 2));
  const Eigen::Vector3d point = sheet.PointAt(u, v);
  const Eigen::Vector3f noise(HashUnit(i, 2, 0, 1), HashUnit(i, 2, 0, 2),
                              HashUnit(i, 2, 0, 3));
  Correspondence c;
  c.model.point = point.cast<float>();
  c.model.normal = sheet.NormalAt(u).cast<float>();
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

EnergyScene::EnergyScene(int nodes, int points)
    : graph(SheetGraph(Sheet(nodes))) {
  const Sheet sheet(nodes);
  const Cells cells(points);
  const SkinningIndex index(graph, kPointNodes);
  for (int i = 0; i < points; ++i) {
    correspondences.push_back(MakeCorrespondence(sheet, cells, index, i));
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
  SolverOptions options = EnergyScene::Options("gn_pcg");
  options.preconditioner = "jacobi";  // As the floor has it.
  BlockProblem blocks(problem, scene.graph);
  BorderedMatrix assembled = blocks.MakeMatrix();
  BorderedVector by_all, step_of_all;
  radius = options.initial_radius;
  for (int i = 1;; ++i) {
    blocks.Evaluate(twists, /*with_jacobians=*/true);
    blocks.Assemble(&assembled, &by_all);
    matrix = assembled.nodes;
    damped = Damped(matrix, radius);
    gradient = by_all.nodes;
    solution = MakePcgSolver(options)->Solve({damped, {}, assembled.corner},
                                             {Negative(gradient), by_all.own},
                                             &step_of_all);
    step = step_of_all.nodes;
    if (i == EnergyScene::kIterations) return;
    for (int k = 0; k < 6 * scene.graph.size(); ++k) {
      twists[k] += step[k / 6][k % 6];
    }
    radius *= 3;
  }
}

}  // namespace splitfusion
