#ifndef SPLITFUSION_COST_FUNCTIONS_TEMPORAL_ARAP_H_
#define SPLITFUSION_COST_FUNCTIONS_TEMPORAL_ARAP_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Eq. 6 with the edges of the frame before in place of those at rest,
///
///   q = R_i R_i,before^T (c_i,before - c_j,before),
///
/// not in the paper: a stiff start that does not unbend what is bent. Its
/// weight is annealed, (anneal - 1) times the one it is given, so that nothing
/// of it is left in the last round. Absent on a one-node graph and where the
/// frame before is not known.
class TemporalArapTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.before == nullptr || input.anneal <= 1) return;
    const DeformationGraph& graph = input.graph;
    const std::vector<NodeMotion>& before = *input.before;
    const auto center = [&](int i) -> Eigen::Vector3d {
      return graph.positions[i] + before[i].translation;
    };
    std::vector<std::vector<int>> nodes;
    std::vector<Arap> functors;
    for (int i = 0; i < graph.size(); ++i) {
      for (const int j : graph.neighbors[i]) {
        nodes.push_back({i, j});
        Arap& arap = functors.emplace_back(Arap::Make(
            graph, i, j,
            before[i].rotation.transpose() * (center(i) - center(j))));
        arap.sqrt_weight = std::sqrt(input.anneal - 1);
      }
    }
    sink->AddNodes(nodes, functors);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_TEMPORAL_ARAP_H_
