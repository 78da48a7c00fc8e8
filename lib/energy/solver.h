#ifndef SPLITFUSION_LIB_ENERGY_SOLVER_H_
#define SPLITFUSION_LIB_ENERGY_SOLVER_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/solver_report.h"
#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

struct LinksInTime;
struct LiveView;

/// Options of the minimiser; names are Ceres' own.
struct SolverOptions {
  /// A name of the SolverRegistry in use.
  std::string solver = "gn_pcg";
  /// "auto" (dense_normal_cholesky for a rigid surface, else
  /// sparse_normal_cholesky), dense_qr, dense_normal_cholesky,
  /// sparse_normal_cholesky, cgnr.
  std::string linear_solver = "auto";
  /// Of gn_pcg and cgnr: jacobi (auto; the diagonal blocks) or identity.
  std::string preconditioner = "auto";
  /// levenberg_marquardt, dogleg or subspace_dogleg.
  std::string trust_region = "levenberg_marquardt";
  /// trust_region, or without one, by line search, lbfgs or nonlinear_cg.
  std::string minimizer = "trust_region";
  /// Of sparse_normal_cholesky: suite_sparse or eigen_sparse.
  std::string sparse_library = "suite_sparse";
  /// Of gn_cholesky and sparse_normal_cholesky with suite_sparse, the order of
  /// elimination: amd (approximate minimum degree), nesdis (nested dissection
  /// by METIS) or natural (as nodes were born).
  std::string ordering = "amd";
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
  bool full_report = false;  ///< Keep a text of all there is to say.
  /// No iteration begins later, seconds; no flag of a run, whose result must
  /// not depend on the clock.
  double max_seconds = 1e9;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;

 private:
  /// What only one of the built-in solvers takes is refused of the others.
  void DemandEffect(OptionList* list) const;
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
  /// First radius of the trust region; 0 = that of the options.
  double initial_radius = 0;
  /// As `live`.
  const std::vector<Correspondence>* lost = nullptr;
  /// As `live`.
  const std::vector<TrackedPoint>* tracks = nullptr;
  int surface = 0;           ///< Id; 0 = background.
  TermContext context = {};  ///< As EnergyInput::context.
  /// Where the terms' own unknowns begin, in order of the energy; empty: at
  /// their initial values.
  std::vector<double> unknowns = {};
  /// As `live`.
  const LinksInTime* links = nullptr;
};

/// A way to minimise energies. Minimize() may run on several threads at once.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Minimises the energy over the twists of all nodes (SplitFusion Eq. 4, 7),
  /// and over the unknowns of the terms' own, which the report has. Composes
  /// the twists onto the motions: R_i <- exp(omega_i) R_i, t_i <- t_i + tau_i,
  /// see CollectResiduals() and ComposeTwists(). The graph is unchanged unless
  /// the report says usable.
  virtual SolverReport Minimize(const SurfaceProblem& problem,
                                DeformationGraph* graph) const = 0;
};

/// Solvers by name, made for their options; a factory throws OptionError on
/// options that its solver cannot take.
using SolverRegistry = Registry<Solver, const SolverOptions&>;

/// gn_pcg and gn_cholesky (see MakeGaussNewton()), and ceres.
SolverRegistry BuiltinSolvers();

/// One minimisation by the solver that the options name.
///
/// @throw OptionError if `solvers` has none of that name.
SolverReport Minimize(const SurfaceProblem& problem,
                      const SolverOptions& options, DeformationGraph* graph,
                      const SolverRegistry& solvers = BuiltinSolvers());

/// Ceres, with all its solvers: the reference.
///
/// @throw OptionError if Ceres does not take the options.
std::unique_ptr<Solver> MakeCeresSolver(const SolverOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SOLVER_H_
