#ifndef SPLITFUSION_COST_FUNCTIONS_VELOCITY_H_
#define SPLITFUSION_COST_FUNCTIONS_VELOCITY_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Way of one node's centre since the frame before, as seen from the world.
///
///   r = c + tau - c_before,   c = g + t
///
/// Block: the node's twist, of which tau alone counts. Residual: 3, metres.
struct Velocity {
  /// Residuals of one node.
  static constexpr int kResiduals = 3;  // Layout.
  Eigen::Vector3d way;                  ///< c - c_before, metres.

  /// `twists`: {twist}.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = T(way[d]) + twists[0][3 + d];
    return true;
  }
};

/// Velocities of all nodes: what nothing else holds stays where it was. Absent
/// on a one-node graph, whose centre is not that of the surface, and where the
/// frame before is not known.
class VelocityTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.before == nullptr || input.graph.rigid()) return;
    std::vector<std::vector<int>> nodes;
    std::vector<Velocity> functors;
    for (int i = 0; i < input.graph.size(); ++i) {
      nodes.push_back({i});
      functors.push_back({input.graph.motions[i].translation -
                          (*input.before)[i].translation});
    }
    sink->AddNodes(nodes, functors);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_VELOCITY_H_
