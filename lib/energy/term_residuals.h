#ifndef SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_

#include <vector>

#include "splitfusion/lib/energy/residual_sink.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// One term of a problem.
struct ProblemTerm {
  TermCost cost;  ///< Name and number of residual vectors; no costs yet.
  /// Its residuals.
  TermResiduals residuals;
};

/// Asks every term of the energy for its residuals at the graph's motions; what
/// all solvers start from.
std::vector<ProblemTerm> CollectResiduals(const SurfaceProblem& problem,
                                          const DeformationGraph& graph);

/// Number of scalar residuals of all terms.
int CountResiduals(const std::vector<ProblemTerm>& terms);

/// Composes the twists (6 per node, [omega, tau]; what follows them is not
/// looked at) onto the motions:
/// R_i <- exp(omega_i) R_i, t_i <- t_i + tau_i.
void ComposeTwists(const std::vector<double>& twists, DeformationGraph* graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_RESIDUALS_H_
