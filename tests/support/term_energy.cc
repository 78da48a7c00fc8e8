#include "support/term_energy.h"

#include "splitfusion/lib/energy/ceres_blocks.h"
#include "splitfusion/lib/energy/warped_points.h"
#include "support/gradient_check.h"

namespace splitfusion {

AddedResiduals ResidualsOf(const EnergyTerm& term, const EnergyInput& input,
                           const TermOptions& options) {
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  term.AddResiduals(input, &sink);
  return {sink.residuals(), sink.residual_vectors()};
}

double EnergyOf(const DeformationGraph& graph, const TermResiduals& residuals) {
  double energy = 0;
  for (const ResidualBlock& block : MakeCeresBlocks(graph, residuals)) {
    const std::vector<std::vector<double>> twists(block.nodes.size(),
                                                  std::vector<double>(6, 0));
    for (const double r : Residuals(*block.cost, twists)) energy += r * r / 2;
  }
  return energy;
}

}  // namespace splitfusion
