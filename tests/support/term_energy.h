#ifndef SPLITFUSION_TESTS_SUPPORT_TERM_ENERGY_H_
#define SPLITFUSION_TESTS_SUPPORT_TERM_ENERGY_H_

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/residual_sink.h"

namespace splitfusion {

/// What a term adds to a sink of these options.
struct AddedResiduals {
  TermResiduals residuals;   ///< Of points and nodes.
  int residual_vectors = 0;  ///< N
};

/// The residuals of a term.
AddedResiduals ResidualsOf(const EnergyTerm& term, const EnergyInput& input,
                           const TermOptions& options);

/// Their energy at the graph's motions, as Ceres adds it up.
double EnergyOf(const DeformationGraph& graph, const TermResiduals& residuals);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_TERM_ENERGY_H_
