#ifndef SPLITFUSION_COST_FUNCTIONS_ARAP_H_
#define SPLITFUSION_COST_FUNCTIONS_ARAP_H_

#include <ceres/rotation.h>

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// As-rigid-as-possible residual of one directed graph edge (i, j).
///
///   r = sqrt(e_ij) [(g_i + t_i) - (g_j + t_j) - R_i (g_i - g_j)]       Eq. 6
///
/// with rest positions g. Under the increments R_i <- exp(omega_i) R_i and
/// t <- t + tau this is
///
///   r = sqrt(e_ij) [c_i + tau_i - c_j - tau_j - exp(omega_i) q],
///   c = g + t,  q = R_i (g_i - g_j).
///
/// Blocks: twist_i, twist_j, each [omega (rad), tau (m)]. Residual: 3, metres *
/// sqrt(weight). Zero for any common rigid motion of both nodes. Reading of the
/// paper: docs/paper_map.md#eq-6
struct Arap {
  /// Residuals of one edge.
  static constexpr int kResiduals = 3;  // Layout.
  Eigen::Vector3d center_i;  ///< c_i = g_i + t_i, camera frame, metres.
  Eigen::Vector3d center_j;  ///< c_j = g_j + t_j.
  Eigen::Vector3d edge;      ///< q, in the camera frame, metres.
  double sqrt_weight = 1;    ///< sqrt(e_ij)

  /// The residual of edge (i, j) about the graph's current motions. `rest`: the
  /// edge from j to i as it is to be, in the canonical frame of node i.
  static Arap Make(const DeformationGraph& graph, int i, int j,
                   const Eigen::Vector3d& rest) {
    return {graph.positions[i] + graph.motions[i].translation,
            graph.positions[j] + graph.motions[j].translation,
            graph.motions[i].rotation * rest, 1.0};
  }

  /// The same with the rest shape: Eq. 6.
  static Arap Make(const DeformationGraph& graph, int i, int j) {
    return Make(graph, i, j, graph.positions[i] - graph.positions[j]);
  }

  /// `twists`: {twist_i, twist_j}.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    const T q[3] = {T(edge.x()), T(edge.y()), T(edge.z())};
    T rotated[3];
    ceres::AngleAxisRotatePoint(twists[0], q, rotated);
    for (int d = 0; d < 3; ++d) {
      residual[d] =
          T(sqrt_weight) * (T(center_i[d]) + twists[0][3 + d] - T(center_j[d]) -
                            twists[1][3 + d] - rotated[d]);
    }
    return true;
  }
};

/// E_prior of Eq. 6: the mean over all directed edges. Absent on a one-node
/// graph.
class ArapTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const DeformationGraph& graph = input.graph;
    std::vector<std::vector<int>> nodes;
    std::vector<Arap> functors;
    for (int i = 0; i < graph.size(); ++i) {
      for (const int j : graph.neighbors[i]) {
        nodes.push_back({i, j});
        functors.push_back(Arap::Make(graph, i, j));
      }
    }
    sink->AddNodes(nodes, functors);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_ARAP_H_
