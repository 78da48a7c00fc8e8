#ifndef SPLITFUSION_COST_FUNCTIONS_ARAP_H_
#define SPLITFUSION_COST_FUNCTIONS_ARAP_H_

#include <ceres/rotation.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "splitfusion/lib/association/seen_nodes.h"
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
  static constexpr int kResiduals = 3;
  Eigen::Vector3d center_i;  ///< c_i = g_i + t_i, camera frame, metres.
  Eigen::Vector3d center_j;  ///< c_j = g_j + t_j.
  Eigen::Vector3d edge;      ///< q = R_i (g_i - g_j).
  double sqrt_weight = 1;    ///< sqrt(e_ij)

  /// The residual of edge (i, j) about the graph's current motions.
  static Arap Make(const DeformationGraph& graph, int i, int j) {
    const Eigen::Vector3d& g_i = graph.positions[i];
    const Eigen::Vector3d& g_j = graph.positions[j];
    return {g_i + graph.motions[i].translation,
            g_j + graph.motions[j].translation,
            graph.motions[i].rotation * (g_i - g_j), 1.0};
  }

  /// What annealing adds to the weight of the prior, `anneal` - 1 times it,
  /// shall not unbend what is bent: it asks that the edge be as it was in the
  /// frame before, turned with its node since,
  ///
  ///   q_before = R_i R_i,before^T (c_i,before - c_j,before).
  ///
  /// But for a constant (and without a robust loss) both energies together are
  /// `anneal` times the prior of the mean edge
  /// (q + (anneal - 1) q_before) / anneal, which replaces q.
  void HoldBend(const DeformationGraph& graph,
                const std::vector<NodeMotion>& before, double anneal, int i,
                int j) {
    const Eigen::Vector3d was = graph.positions[i] + before[i].translation -
                                (graph.positions[j] + before[j].translation);
    const Eigen::Matrix3d turn =
        graph.motions[i].rotation * before[i].rotation.transpose();
    edge += (anneal - 1) / anneal * (turn * was - edge);
  }

  /// A part of `share` of the prior holds the shape that the edge had when it
  /// was last seen, DeformationGraph::seen_edges, instead of the rest shape: as
  /// in HoldBend(), the mean edge replaces q. `k`: of the neighbours of i.
  void HoldSeen(const DeformationGraph& graph, double share, int i,
                std::size_t k) {
    edge += share * (graph.motions[i].rotation * graph.seen_edges[i][k] - edge);
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

/// E_prior of Eq. 6 over all directed edges; absent on a one-node graph. While
/// it is annealed, what it weighs more holds the bend of the frame before, if
/// that is known.
///
/// Where nothing is seen there is nothing but the prior, and it would take a
/// bent limb back to its rest shape as soon as another one hides it. Of edges
/// of which an end is not seen, a part holds the shape that was last seen. The
/// other part is kept, as what was last seen may be wrong.
class ArapTerm : public EnergyTerm {
 public:
  /// Part of the prior of a hidden edge that holds the shape last seen.
  static constexpr double kHeld = 0.5;

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const DeformationGraph& graph = input.graph;
    const bool holds = KnowsSeenEdges(graph);
    const std::vector<double> seen =
        holds ? SeenShares(input.correspondences, graph.size())
              : std::vector<double>(graph.size(), 1.0);
    std::vector<std::vector<int>> nodes;
    std::vector<Arap> functors;
    for (int i = 0; i < graph.size(); ++i) {
      for (std::size_t k = 0; k < graph.neighbors[i].size(); ++k) {
        const int j = graph.neighbors[i][k];
        nodes.push_back({i, j});
        Arap& arap = functors.emplace_back(Arap::Make(graph, i, j));
        const double hidden = 1 - std::min(seen[i], seen[j]);
        if (holds) arap.HoldSeen(graph, kHeld * hidden, i, k);
        if (input.before == nullptr) continue;
        arap.HoldBend(graph, *input.before, input.anneal, i, j);
      }
    }
    sink->AddNodes(nodes, functors);
  }

  bool is_prior() const override { return true; }

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

#endif  // SPLITFUSION_COST_FUNCTIONS_ARAP_H_
