#ifndef SPLITFUSION_COST_FUNCTIONS_ACCELERATION_H_
#define SPLITFUSION_COST_FUNCTIONS_ACCELERATION_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/cost_functions/velocity.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/surface_history.h"

namespace splitfusion {

/// Second differences in time of the centres of all nodes, as seen from the
/// world:
///
///   r = (c + tau) - 2 c_1 + c_2,   c = g + t
///
/// c_1 and c_2 are those of the two frames before. What nothing else holds goes
/// on at constant velocity. Residual: that of Velocity, with the way from where
/// such a motion would have ended; 3, metres a frame squared.
///
/// Absent on a one-node graph, whose centre is not that of the surface, and
/// unless the surface was tracked in both frames before, at equal steps of
/// their indices, and is not looked for elsewhere.
class AccelerationTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (!HasSteadyPast(input)) return;
    const DeformationGraph& graph = input.graph;
    const std::vector<NodeMotion> earlier = input.context.history->Before(2);
    if (static_cast<int>(earlier.size()) != graph.size()) return;
    std::vector<std::vector<int>> nodes;
    std::vector<Velocity> functors;
    for (int i = 0; i < graph.size(); ++i) {
      // The rest positions g cancel out.
      nodes.push_back({i});
      functors.push_back({graph.motions[i].translation -
                          2 * (*input.before)[i].translation +
                          earlier[i].translation});
    }
    sink->AddNodes(nodes, functors);
  }

 private:
  static bool HasSteadyPast(const EnergyInput& input) {
    const TermContext& context = input.context;
    if (context.frame == nullptr || context.history == nullptr ||
        input.before == nullptr || input.graph.rigid()) {
      return false;
    }
    const auto last = context.history->Find(1);
    const auto earlier = context.history->Find(2);
    return last && earlier && last->tracked && earlier->tracked &&
           context.frame->index - last->frame == last->frame - earlier->frame;
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_ACCELERATION_H_
