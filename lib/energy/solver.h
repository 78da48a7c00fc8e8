#ifndef SPLITFUSION_LIB_ENERGY_SOLVER_H_
#define SPLITFUSION_LIB_ENERGY_SOLVER_H_

#include <string>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/solver_report.h"
#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

struct LiveView;

/// Options of the minimiser; names are Ceres' own.
struct SolverOptions {
  /// gn_pcg or gn_cholesky (block Gauss-Newton over the same residuals, see
  /// MinimizeWithGaussNewton), or ceres, the reference.
  std::string solver = "gn_pcg";
  /// "auto" (dense_normal_cholesky for a rigid surface, else
  /// sparse_normal_cholesky), dense_qr, dense_normal_cholesky,
  /// sparse_normal_cholesky, cgnr.
  std::string linear_solver = "auto";
  /// Of gn_pcg: two_level, jacobi, block_ic0 or identity, see
  /// MakePreconditioner(); of cgnr: jacobi or identity. "auto" is the first of
  /// either.
  std::string preconditioner = "auto";
  /// levenberg_marquardt or dogleg.
  std::string trust_region = "levenberg_marquardt";
  int threads = 1;         ///< Of Ceres; with more the last digits vary.
  int max_iterations = 1;  ///< Per association: a new one tells more.
  int max_linear_solver_iterations = 100;  ///< For cgnr and gn_pcg.
  double eta = 0.01;  ///< For cgnr and gn_pcg: relative accuracy of a step.
  /// Converged when the cost changes by less, relative. Ceres does not take
  /// such a step, the other solvers do: with one iteration per association it
  /// is to be so small that they agree.
  double function_tolerance = 1e-10;
  /// Converged when the gradient's largest entry is below.
  double gradient_tolerance = 1e-10;
  /// Converged when the step is below (radians, metres).
  double parameter_tolerance = 1e-8;
  /// Of the trust region: Levenberg-Marquardt raises the diagonal of J^T J by
  /// itself / radius. With Ceres' own 1e4, hidden parts with few edges to
  /// the rest swing by up to a right angle in a frame; with 1e2, limbs in view
  /// are followed too slowly.
  double initial_radius = 1e3;
  bool full_report = false;  ///< Keep Ceres' FullReport() text.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

/// The problem of one surface at one association.
struct SurfaceProblem {
  /// The weighted terms, Eq. 4.
  const Energy& energy;
  /// Pairs of model and live points of the surface.
  const std::vector<Correspondence>& correspondences;
  const PinholeCamera& camera;  ///< Live camera.
  /// For terms that ask for them, see EnergyInput; may be null.
  const LiveView* live = nullptr;
  /// As `live`.
  const std::vector<NodeMotion>* before = nullptr;
  /// As EnergyInput::anneal.
  double anneal = 1;
};

/// Minimises the energy over the twists of all nodes (SplitFusion Eq. 4, 7) and
/// composes them onto the motions: R_i <- exp(omega_i) R_i, t_i <- t_i + tau_i.
/// The graph is unchanged unless the report says usable.
SolverReport Minimize(const SurfaceProblem& problem,
                      const SolverOptions& options, DeformationGraph* graph);

/// The same by Ceres: the reference, with all its solvers.
SolverReport MinimizeWithCeres(const SurfaceProblem& problem,
                               const SolverOptions& options,
                               DeformationGraph* graph);

/// The same by Levenberg-Marquardt on assembled 6x6 blocks of J^T J, solved by
/// preconditioned conjugate gradients (gn_pcg; Eq. 7 as the paper solves it) or
/// by a sparse Cholesky factorisation (gn_cholesky). Residuals, losses and
/// damping are those of Ceres. Results do not depend on the number of threads.
SolverReport MinimizeWithGaussNewton(const SurfaceProblem& problem,
                                     const SolverOptions& options,
                                     DeformationGraph* graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SOLVER_H_
