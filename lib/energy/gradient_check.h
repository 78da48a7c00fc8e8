#ifndef SPLITFUSION_LIB_ENERGY_GRADIENT_CHECK_H_
#define SPLITFUSION_LIB_ENERGY_GRADIENT_CHECK_H_

#include <string>
#include <vector>

#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// How well a term's derivatives agree with its costs.
struct GradientError {
  std::string term;  ///< Registered name.
  /// Largest deviation, over the largest slope; the larger one of those by the
  /// twists and by the term's own unknowns.
  double relative = 0;
  int failed = 0;     ///< Directions in which cost or slope is not finite.
  int residuals = 0;  ///< Scalar residuals; of none nothing is known.
};

/// Compares the slope of every term's cost along random directions of all
/// twists, and of its own unknowns, as the derivatives have it, with symmetric
/// differences of the cost (Ridders 1982), about where the graph is and the
/// unknowns begin. Terms without residuals have the
/// deviation 0. Losses are smooth but where residuals change between their
/// branches; derivatives that are right deviate by less than 1e-5.
std::vector<GradientError> CheckGradients(const SurfaceProblem& problem,
                                          const DeformationGraph& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_GRADIENT_CHECK_H_
