#include "splitfusion/lib/energy/term_blocks.h"

#include <utility>

namespace splitfusion {

std::vector<TermBlocks> CollectBlocks(const SurfaceProblem& problem,
                                      const DeformationGraph& graph) {
  const EnergyInput input{graph, problem.correspondences, problem.camera,
                          problem.live, problem.before};
  std::vector<TermBlocks> terms;
  for (const WeightedTerm& term : problem.energy) {
    const double factor = term.term->is_prior() ? problem.prior_factor : 1.0;
    ResidualSink sink(graph, term.options, factor);
    term.term->AddResiduals(input, &sink);
    TermBlocks blocks;
    blocks.cost.term = term.options.name;
    blocks.cost.residual_vectors = sink.residual_vectors();
    blocks.blocks = std::move(sink.blocks());
    terms.push_back(std::move(blocks));
  }
  return terms;
}

void ComposeTwists(const std::vector<double>& twists, DeformationGraph* graph) {
  for (int i = 0; i < graph->size(); ++i) {
    const Eigen::Map<const Eigen::Vector3d> omega(&twists[kTwistSize * i]);
    const Eigen::Map<const Eigen::Vector3d> tau(&twists[kTwistSize * i + 3]);
    NodeMotion& motion = graph->motions[i];
    motion.rotation = Orthonormalized(ExpSo3(omega) * motion.rotation);
    motion.translation += tau;
  }
}

}  // namespace splitfusion
