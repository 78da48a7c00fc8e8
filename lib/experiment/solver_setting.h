#ifndef SPLITFUSION_LIB_EXPERIMENT_SOLVER_SETTING_H_
#define SPLITFUSION_LIB_EXPERIMENT_SOLVER_SETTING_H_

#include <string>
#include <vector>

#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// One way to solve.
struct SolverSetting {
  std::string name;            ///< As it was given, "ceres:cgnr:identity".
  std::string solver;          ///< The same without the preconditioner.
  std::string preconditioner;  ///< In use; "none" of what takes none.
  SolverOptions options;       ///< All of it.
};

/// A setting from text: a solver, and after colons what is chosen of it, in any
/// order, each a value of linear_solver, preconditioner, trust_region,
/// minimizer, sparse_library or ordering. `base`: all other options.
///
/// @throw OptionError on a word that none of them has, or on choices that do
///     not go together.
SolverSetting ParseSolverSetting(const std::string& text,
                                 const SolverOptions& base,
                                 const SolverRegistry& solvers);

/// What sf_solve compares unless it is told: every built-in way.
std::vector<std::string> BuiltinSolverSettings();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SOLVER_SETTING_H_
