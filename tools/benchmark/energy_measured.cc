#include "energy_measured.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace splitfusion {
namespace {

constexpr double kTolerance = 1e-6;

/// Rows and residuals of one block at the twists, as the loss scales them.
struct EvaluatedRows {
  std::vector<int> nodes;  // Ascending.
  std::vector<double> rows;
  std::vector<double> residuals;
};

EvaluatedRows Evaluate(const PlainResidual& residual,
                       const ceres::LossFunction& loss,
                       const std::vector<double>& twists) {
  const int n = static_cast<int>(residual.nodes.size());
  const int count = residual.cost->num_residuals();
  std::vector<const double*> parameters;
  std::vector<std::vector<double>> jacobians(n, std::vector<double>(6 * count));
  std::vector<double*> outputs;
  for (int k = 0; k < n; ++k) {
    parameters.push_back(&twists[6 * residual.nodes[k]]);
    outputs.push_back(jacobians[k].data());
  }
  EvaluatedRows out{residual.nodes, std::vector<double>(6 * n * count),
                    std::vector<double>(count)};
  residual.cost->Evaluate(parameters.data(), out.residuals.data(),
                          outputs.data());
  double squared = 0;
  for (const double r : out.residuals) squared += r * r;
  double rho[3];
  loss.Evaluate(squared, rho);
  std::sort(out.nodes.begin(), out.nodes.end());
  for (int k = 0; k < n; ++k) {
    const int rank =
        static_cast<int>(std::lower_bound(out.nodes.begin(), out.nodes.end(),
                                          residual.nodes[k]) -
                         out.nodes.begin());
    for (int e = 0; e < 6 * count; ++e) {
      out.rows[6 * (e / 6 * n + rank) + e % 6] =
          std::sqrt(rho[1]) * jacobians[k][e];
    }
  }
  for (double& r : out.residuals) r *= std::sqrt(rho[1]);
  return out;
}

/// All residuals, gathered by their nodes.
FloorRows GatherRows(int nodes_per_row,
                     const std::vector<PlainResidual>& residuals,
                     const ceres::LossFunction& loss,
                     const std::vector<double>& twists) {
  std::map<std::vector<int>, EvaluatedRows> groups;
  for (const PlainResidual& residual : residuals) {
    const EvaluatedRows more = Evaluate(residual, loss, twists);
    EvaluatedRows& group = groups[more.nodes];
    group.rows.insert(group.rows.end(), more.rows.begin(), more.rows.end());
    group.residuals.insert(group.residuals.end(), more.residuals.begin(),
                           more.residuals.end());
  }
  FloorRows rows;
  rows.nodes_per_row = nodes_per_row;
  for (const auto& [nodes, group] : groups) {
    rows.Add(nodes, group.rows, group.residuals);
  }
  return rows;
}

EnergyFloor MakeFloor(const EnergyScene& scene,
                      const std::vector<double>& twists) {
  return EnergyFloor(
      scene.graph.size(),
      GatherRows(EnergyScene::kPointNodes, PlainPoints(scene),
                 *PlainPointLoss(scene), twists),
      GatherRows(2, PlainEdges(scene), *PlainEdgeLoss(scene), twists));
}

/// |a - b| / |b| of n numbers, largest entries.
double Difference(const double* a, const double* b, std::size_t n) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

bool SameMatrix(const FloorMatrix& floor, const SymmetricBlockMatrix& matrix) {
  return floor.row_begin == matrix.row_begin() &&
         floor.columns == matrix.columns() &&
         Difference(floor.blocks.data(), matrix.blocks().data()->data(),
                    floor.blocks.size()) < kTolerance;
}

/// |A x + g| / |g| of the step x that the library takes by default.
double DefaultResidual(const EnergyScene& scene, const MeasuredSystem& system,
                       const SolverOptions& options) {
  std::vector<Vector6> right = system.gradient, step;
  for (Vector6& v : right) v = -v;
  MakePcgSolver(options, scene.graph)->Solve(system.damped, right, &step);
  std::vector<Vector6> product(step.size());
  system.damped.Multiply(step, &product);
  double squared = 0, size = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    squared += (product[i] - right[i]).squaredNorm();
    size += right[i].squaredNorm();
  }
  return std::sqrt(squared / size);
}

}  // namespace

MeasuredEnergy::MeasuredEnergy()
    : system_(scene_),
      floor_(MakeFloor(scene_, system_.twists)),
      disagreement_(Disagreement()) {}

int MeasuredEnergy::RunFloor(EnergyFloor* floor) const {
  const SolverOptions options = EnergyScene::Options("gn_pcg");
  floor->Assemble();
  floor->Damp(system_.radius);
  return floor->Solve(options.eta, options.max_linear_solver_iterations);
}

std::string MeasuredEnergy::Disagreement() {
  floor_.Assemble();
  if (!SameMatrix(floor_.matrix(), system_.matrix)) {
    return "the floor's matrix is not the library's";
  }
  if (Difference(floor_.matrix().gradient.data(),
                 system_.gradient.data()->data(),
                 6 * system_.gradient.size()) > kTolerance) {
    return "the floor's gradient is not the library's";
  }
  if (RunFloor(&floor_) != system_.solution.iterations ||
      Difference(floor_.solution().data(), system_.step.data()->data(),
                 6 * system_.step.size()) > kTolerance) {
    return "the floor's step is not the library's";
  }
  const SolverOptions options = EnergyScene::Options("gn_pcg");
  if (DefaultResidual(scene_, system_, options) > options.eta) {
    return "the default step does not solve the system";
  }
  const Energy energy = EnergyScene::MakeEnergy(/*custom=*/false);
  DeformationGraph graph = scene_.graph;
  const SolverReport report =
      Minimize(scene_.Problem(energy), EnergyScene::CeresOptions(), &graph);
  double reference = 0;
  PlainProblem(scene_).Iterate(&reference);
  if (std::abs(report.final_cost - reference) > kTolerance * reference) {
    return "the reference's cost is not that of grouped blocks";
  }
  return "";
}

}  // namespace splitfusion
