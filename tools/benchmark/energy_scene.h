#ifndef SPLITFUSION_TOOLS_BENCHMARK_ENERGY_SCENE_H_
#define SPLITFUSION_TOOLS_BENCHMARK_ENERGY_SCENE_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/linear_solver.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// A surface of 400 nodes with 30,000 correspondences: a sheet of 0.8 x 0.8 m,
/// bent like a chest, whose live points have moved smoothly by up to 2 cm, with
/// noise of the depth. With more or fewer nodes, 4 cm apart as before, it is
/// larger or smaller and bent by the same angle.
struct EnergyScene {
  explicit EnergyScene(int nodes = kNodes, int points = kPoints);

  static constexpr int kNodes = 400;     ///< Of the graph, if not asked.
  static constexpr int kPoints = 30000;  ///< Correspondences, if not asked.
  static constexpr int kPointNodes = 6;  ///< That carry a point.
  static constexpr int kIterations = 2;  ///< The last one is the measured one.

  /// Point-to-plane distances and ARAP, with the weights and the loss of the
  /// default energy; `custom`: the distances by UserPointToPlane.
  static Energy MakeEnergy(bool custom);

  /// Options of that solver; it does kIterations and never stops early.
  static SolverOptions Options(const std::string& solver);

  /// The same for Ceres with conjugate gradients on the normal equations and
  /// block Jacobi, on all cores, as gn_pcg.
  static SolverOptions CeresOptions();

  /// The problem of `energy`, which must outlive it.
  SurfaceProblem Problem(const Energy& energy) const;

  DeformationGraph graph;                       ///< At rest.
  std::vector<Correspondence> correspondences;  ///< All nodes six.
  PinholeCamera camera;                         ///< Not looked at.
};

/// The linear system of the measured iteration, as gn_pcg has it.
struct MeasuredSystem {
  /// Does the iterations before.
  explicit MeasuredSystem(const EnergyScene& scene);

  std::vector<double> twists;     ///< Six a node; the residuals are at these.
  double radius;                  ///< Of the damping.
  SymmetricBlockMatrix matrix;    ///< J^T J
  SymmetricBlockMatrix damped;    ///< J^T J + D / radius, D its diagonal.
  std::vector<Vector6> gradient;  ///< J^T r
  std::vector<Vector6> step;      ///< Solves damped x = -gradient.
  LinearSolution solution;        ///< How well.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_ENERGY_SCENE_H_
