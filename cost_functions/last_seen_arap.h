#ifndef SPLITFUSION_COST_FUNCTIONS_LAST_SEEN_ARAP_H_
#define SPLITFUSION_COST_FUNCTIONS_LAST_SEEN_ARAP_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/visibility/seen_nodes.h"

namespace splitfusion {

/// Eq. 6 on the edges that are hidden, with the shape in which they were last
/// seen (DeformationGraph::seen_edges) in place of that at rest; not in the
/// paper. Where nothing is seen there is nothing but the prior, and it would
/// take a bent limb back to its rest shape as soon as another one hides it. An
/// edge counts as far as the more hidden of its ends is not seen.
class LastSeenArapTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const DeformationGraph& graph = input.graph;
    if (!KnowsSeenEdges(graph)) return;
    const std::vector<double> seen =
        SeenShares(input.correspondences, graph.size());
    std::vector<std::vector<int>> nodes;
    std::vector<Arap> functors;
    double edges = 0;
    for (int i = 0; i < graph.size(); ++i) {
      for (std::size_t k = 0; k < graph.neighbors[i].size(); ++k) {
        ++edges;
        const int j = graph.neighbors[i][k];
        const double hidden = 1 - std::min(seen[i], seen[j]);
        if (hidden <= 0) continue;
        nodes.push_back({i, j});
        Arap& arap = functors.emplace_back(
            Arap::Make(graph, i, j, graph.seen_edges[i][k]));
        arap.sqrt_weight = std::sqrt(hidden);
      }
    }
    // As many as of Eq. 6, so that weights compare.
    sink->AddNodes(nodes, functors, edges);
  }

 private:
  static bool KnowsSeenEdges(const DeformationGraph& graph) {
    return std::equal(graph.seen_edges.begin(), graph.seen_edges.end(),
                      graph.neighbors.begin(), graph.neighbors.end(),
                      [](const auto& edges, const auto& neighbors) {
                        return edges.size() == neighbors.size();
                      });
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_LAST_SEEN_ARAP_H_
