#ifndef SPLITFUSION_TOOLS_BENCHMARK_ENERGY_REFERENCE_H_
#define SPLITFUSION_TOOLS_BENCHMARK_ENERGY_REFERENCE_H_

#include <ceres/ceres.h>

#include <memory>
#include <vector>

#include "energy_scene.h"

namespace splitfusion {

/// A residual vector as one writes it down first: an AutoDiffCostFunction over
/// the twists of its nodes, residuals in units of 1 cm.
struct PlainResidual {
  std::unique_ptr<ceres::CostFunction> cost;  ///< One block of six a node.
  std::vector<int> nodes;                     ///< Of its blocks, in order.
};

/// Point-to-plane distances, six nodes each: 36 columns.
std::vector<PlainResidual> PlainPoints(const EnergyScene& scene);

/// ARAP residuals, one a directed edge.
std::vector<PlainResidual> PlainEdges(const EnergyScene& scene);

/// Loss and weight of the point-to-plane distances and of the ARAP residuals.
std::unique_ptr<ceres::LossFunction> PlainPointLoss(const EnergyScene& scene);
/// See PlainPointLoss.
std::unique_ptr<ceres::LossFunction> PlainEdgeLoss(const EnergyScene& scene);

/// Ceres with one residual block a point, conjugate gradients on the normal
/// equations, preconditioned by block Jacobi.
class PlainProblem {
 public:
  /// Builds it.
  explicit PlainProblem(const EnergyScene& scene);
  /// Seconds of the last of kIterations from rest; `final_cost` may be null.
  double Iterate(double* final_cost);

 private:
  void Add(std::vector<PlainResidual> residuals, ceres::LossFunction* loss);

  std::vector<double> twists_;
  ceres::Problem problem_;
  std::unique_ptr<ceres::LossFunction> point_loss_;
  std::unique_ptr<ceres::LossFunction> edge_loss_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_ENERGY_REFERENCE_H_
