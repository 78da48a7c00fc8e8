#include "energy_reference.h"

#include <algorithm>
#include <array>
#include <utility>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/warp_functor.h"

namespace splitfusion {
namespace {

constexpr double kUnitsPerMetre = 1 / kResidualUnit;

/// Point-to-plane distance of the point that six nodes carry, as lean as one
/// pass of autodiff allows: constants are numbers, not Jets.
struct SixNodeDistance {
  std::array<NodeTransport, EnergyScene::kPointNodes> nodes;
  PointToPlane plane;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* d, const T* e,
                  const T* f, T* residual) const {
    const T* twists[] = {a, b, c, d, e, f};
    const double scale = kUnitsPerMetre * plane.sqrt_confidence;
    residual[0] = T(-scale * plane.normal.dot(plane.target));
    for (int k = 0; k < EnergyScene::kPointNodes; ++k) {
      const NodeTransport& node = nodes[k];
      const T q[] = {T(node.rotated.x()), T(node.rotated.y()),
                     T(node.rotated.z())};
      T moved[3];
      ceres::AngleAxisRotatePoint(twists[k], q, moved);
      for (int axis = 0; axis < 3; ++axis) {
        residual[0] += (scale * node.weight * plane.normal[axis]) *
                       (moved[axis] + twists[k][3 + axis] + node.center[axis]);
      }
    }
    return true;
  }
};

SixNodeDistance MakeDistance(const EnergyScene& scene,
                             const Correspondence& c) {
  SixNodeDistance distance;
  for (int k = 0; k < EnergyScene::kPointNodes; ++k) {
    distance.nodes[k] = MakeTransport(scene.graph, c.model.skinning.nodes[k],
                                      c.model.skinning.weights[k],
                                      c.model.point.cast<double>());
  }
  distance.plane = {c.warped_normal.cast<double>(), c.target.cast<double>(),
                    std::sqrt(c.weight)};
  return distance;
}

struct EdgeResidual {
  Arap arap;

  template <typename T>
  bool operator()(const T* twist_i, const T* twist_j, T* residual) const {
    const T* twists[] = {twist_i, twist_j};
    if (!arap(twists, residual)) return false;
    for (int d = 0; d < 3; ++d) residual[d] *= T(kUnitsPerMetre);
    return true;
  }
};

/// weight / N * 2 rho: Ceres halves it. `total`: N.
std::unique_ptr<ceres::LossFunction> Weighted(ceres::LossFunction* loss,
                                              double weight, double total) {
  return std::make_unique<ceres::ScaledLoss>(loss, 2 * weight / total,
                                             ceres::TAKE_OWNERSHIP);
}

TermOptions OptionsOf(const std::string& term) {
  const Energy energy = EnergyScene::MakeEnergy(/*custom=*/false);
  return std::find_if(energy.begin(), energy.end(),
                      [&](const WeightedTerm& weighted) {
                        return weighted.options.name == term;
                      })
      ->options;
}

ceres::Problem::Options Unchecked() {
  ceres::Problem::Options options;
  options.disable_all_safety_checks = true;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

}  // namespace

std::vector<PlainResidual> PlainPoints(const EnergyScene& scene) {
  std::vector<PlainResidual> residuals;
  for (const Correspondence& c : scene.correspondences) {
    const Skinning& skinning = c.model.skinning;
    if (skinning.count != EnergyScene::kPointNodes) {
      throw InputError("nodes of a point = " + std::to_string(skinning.count) +
                       ": expected " +
                       std::to_string(EnergyScene::kPointNodes));
    }
    residuals.push_back(
        {std::make_unique<
             ceres::AutoDiffCostFunction<SixNodeDistance, 1, 6, 6, 6, 6, 6, 6>>(
             new SixNodeDistance(MakeDistance(scene, c))),
         std::vector<int>(skinning.nodes.begin(),
                          skinning.nodes.begin() + skinning.count)});
  }
  return residuals;
}

std::vector<PlainResidual> PlainEdges(const EnergyScene& scene) {
  std::vector<PlainResidual> residuals;
  for (int i = 0; i < scene.graph.size(); ++i) {
    for (const int j : scene.graph.neighbors[i]) {
      residuals.push_back(
          {std::make_unique<ceres::AutoDiffCostFunction<EdgeResidual, 3, 6, 6>>(
               new EdgeResidual{Arap::Make(scene.graph, i, j)}),
           {i, j}});
    }
  }
  return residuals;
}

std::unique_ptr<ceres::LossFunction> PlainPointLoss(const EnergyScene& scene) {
  const TermOptions options = OptionsOf("point_to_plane");
  double total = 0;
  for (const Correspondence& c : scene.correspondences) total += c.weight;
  return Weighted(new ceres::TukeyLoss(options.scale * kUnitsPerMetre),
                  options.weight, total);
}

std::unique_ptr<ceres::LossFunction> PlainEdgeLoss(const EnergyScene& scene) {
  int edges = 0;
  for (const auto& neighbors : scene.graph.neighbors) {
    edges += static_cast<int>(neighbors.size());
  }
  return Weighted(new ceres::TrivialLoss, OptionsOf("arap").weight, edges);
}

PlainProblem::PlainProblem(const EnergyScene& scene)
    : twists_(6 * scene.graph.size(), 0.0),
      problem_(Unchecked()),
      point_loss_(PlainPointLoss(scene)),
      edge_loss_(PlainEdgeLoss(scene)) {
  for (int i = 0; i < scene.graph.size(); ++i) {
    problem_.AddParameterBlock(&twists_[6 * i], 6);
  }
  Add(PlainPoints(scene), point_loss_.get());
  Add(PlainEdges(scene), edge_loss_.get());
}

void PlainProblem::Add(std::vector<PlainResidual> residuals,
                       ceres::LossFunction* loss) {
  for (PlainResidual& residual : residuals) {
    std::vector<double*> blocks;
    for (const int node : residual.nodes) blocks.push_back(&twists_[6 * node]);
    problem_.AddResidualBlock(residual.cost.release(), loss, blocks);
  }
}

double PlainProblem::Iterate(double* final_cost) {
  std::fill(twists_.begin(), twists_.end(), 0.0);
  const SolverOptions settings = EnergyScene::CeresOptions();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::CGNR;
  options.preconditioner_type = ceres::JACOBI;
  options.num_threads = settings.threads;
  options.max_num_iterations = settings.max_iterations;
  options.max_linear_solver_iterations = settings.max_linear_solver_iterations;
  options.eta = settings.eta;
  options.function_tolerance = 0;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 0;
  options.initial_trust_region_radius = settings.initial_radius;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  if (final_cost != nullptr) *final_cost = summary.final_cost;
  return summary.iterations.back().iteration_time_in_seconds;
}

}  // namespace splitfusion
