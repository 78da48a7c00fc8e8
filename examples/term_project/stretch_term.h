#ifndef TERM_PROJECT_STRETCH_TERM_H_
#define TERM_PROJECT_STRETCH_TERM_H_

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"

/// How much longer or shorter an edge of the deformation graph is than at rest.
///
///   r = |c_i + tau_i - c_j - tau_j| - |g_i - g_j|,   c = g + t
///
/// g: rest positions, t: translations so far, tau: those sought. Residual: 1,
/// metres. Zero for any common rigid motion, and for bends that keep lengths,
/// which Eq. 6 (arap) does not allow.
struct Stretch {
  static constexpr int kResiduals = 1;
  Eigen::Vector3d edge;  ///< c_i - c_j, metres.
  double length;         ///< |g_i - g_j|, metres.

  /// `twists`: of the two nodes, [omega (rad), tau (m)].
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T square(0);
    for (int d = 0; d < 3; ++d) {
      const T x = T(edge[d]) + twists[0][3 + d] - twists[1][3 + d];
      square += x * x;
    }
    using std::sqrt;
    residual[0] = sqrt(square) - T(length);
    return true;
  }
};

/// Stretch of all edges of the graph that are longer than `least` at rest.
class StretchTerm : public splitfusion::EnergyTerm {
 public:
  void List(splitfusion::OptionList* list) override {
    list->Number("least", &least_, splitfusion::Range::AtLeast(0), "metres",
                 "Edges that are shorter at rest are left out.");
  }

  void AddResiduals(const splitfusion::EnergyInput& input,
                    splitfusion::ResidualSink* sink) const override {
    const splitfusion::DeformationGraph& graph = input.graph;
    std::vector<std::vector<int>> nodes;
    std::vector<Stretch> residuals;
    for (int i = 0; i < graph.size(); ++i) {
      for (const int j : graph.neighbors[i]) {
        const Eigen::Vector3d rest = graph.positions[i] - graph.positions[j];
        const Eigen::Vector3d edge =
            rest + graph.motions[i].translation - graph.motions[j].translation;
        // The length of nothing has no derivative.
        if (j < i || rest.norm() < least_ || edge.isZero()) continue;
        nodes.push_back({i, j});
        residuals.push_back({edge, rest.norm()});
      }
    }
    sink->AddNodes(nodes, residuals);
  }

 private:
  double least_ = 0;
};

#endif  // TERM_PROJECT_STRETCH_TERM_H_
