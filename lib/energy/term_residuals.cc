#include "splitfusion/lib/energy/term_residuals.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_call.h"
#include "splitfusion/lib/energy/term_unknowns.h"
#include "splitfusion/lib/energy/twist.h"
#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {

std::vector<ProblemTerm> CollectResiduals(const SurfaceProblem& problem,
                                          const DeformationGraph& graph) {
  return CollectResiduals(problem, TermUnknowns(problem), graph);
}

std::vector<ProblemTerm> CollectResiduals(const SurfaceProblem& problem,
                                          const TermUnknowns& unknowns,
                                          const DeformationGraph& graph) {
  EnergyInput input{graph,          problem.correspondences, problem.camera,
                    problem.live,   problem.before,          problem.anneal,
                    problem.lost,   problem.tracks,          problem.surface,
                    problem.context};
  input.links = problem.links;
  const TermStates* states = problem.context.states;
  std::vector<ProblemTerm> terms;
  WarpedPointsCache cache(graph.size());
  for (std::size_t i = 0; i < problem.energy.size(); ++i) {
    const WeightedTerm& weighted = problem.energy[i];
    input.options = &weighted.options;
    if (states != nullptr) {
      input.state = states->Find(problem.energy, i);
      input.begun = states->Begun(problem.energy, i);
    }
    ResidualSink sink(weighted.options, &cache, unknowns.ScalesOf(i));
    CallTerm(weighted.options.name, "AddResiduals()",
             [&] { weighted.term->AddResiduals(input, &sink); });
    ProblemTerm term;
    term.cost.term = weighted.options.name;
    term.cost.residual_vectors = sink.residual_vectors();
    term.residuals = sink.residuals();
    terms.push_back(std::move(term));
  }
  return terms;
}

std::string NotFiniteText(const std::vector<ProblemTerm>& terms,
                          const std::vector<double>& costs) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (std::isfinite(costs[i])) continue;
    return "The cost of term '" + terms[i].cost.term + "' is not finite.";
  }
  const double sum = std::accumulate(costs.begin(), costs.end(), 0.0);
  return std::isfinite(sum) ? "" : "The cost of all terms is not finite.";
}

int CountResiduals(const std::vector<ProblemTerm>& terms) {
  int count = 0;
  for (const ProblemTerm& term : terms) {
    const TermResiduals& residuals = term.residuals;
    if (residuals.points != nullptr) {
      count += residuals.points->size() * residuals.of_points->dims();
    }
    if (residuals.of_nodes != nullptr) {
      count += residuals.of_nodes->size() * residuals.of_nodes->dims();
    }
    if (residuals.of_unknowns != nullptr) {
      count += residuals.of_unknowns->rows();
    }
  }
  return count;
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
