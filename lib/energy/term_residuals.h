#ifndef SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_

#include <string>
#include <vector>

#include "splitfusion/lib/energy/residual_sink.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

class TermUnknowns;

/// One term of a problem.
struct ProblemTerm {
  TermCost cost;  ///< Name and number of residual vectors; no costs yet.
  /// Its residuals.
  TermResiduals residuals;
};

/// Asks every term of the energy for its residuals at the graph's motions; what
/// all solvers start from.
///
/// @throw InputError if a term is not what it must be, or adds what it must
///     not; std::runtime_error of anything else that it throws. Both name it.
std::vector<ProblemTerm> CollectResiduals(const SurfaceProblem& problem,
                                          const DeformationGraph& graph);

/// The same, where the terms' own unknowns are known; those of the problem.
std::vector<ProblemTerm> CollectResiduals(const SurfaceProblem& problem,
                                          const TermUnknowns& unknowns,
                                          const DeformationGraph& graph);

/// A sentence on the first term whose cost is not finite, or on the sum of all
/// if that is not; empty if all are. `costs`: of `terms`.
std::string NotFiniteText(const std::vector<ProblemTerm>& terms,
                          const std::vector<double>& costs);

/// Number of scalar residuals of all terms.
int CountResiduals(const std::vector<ProblemTerm>& terms);

/// Composes the twists (6 per node, [omega, tau]; what follows them is not
/// looked at) onto the motions:
/// R_i <- exp(omega_i) R_i, t_i <- t_i + tau_i.
void ComposeTwists(const std::vector<double>& twists, DeformationGraph* graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_
