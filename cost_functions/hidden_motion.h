#ifndef SPLITFUSION_COST_FUNCTIONS_HIDDEN_MOTION_H_
#define SPLITFUSION_COST_FUNCTIONS_HIDDEN_MOTION_H_

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "splitfusion/cost_functions/arap.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/links_in_time.h"
#include "splitfusion/lib/energy/twist.h"

namespace splitfusion {

/// Nodes of a tuple, and which of them are sought: the twists of these alone
/// are the blocks of its residual.
template <std::size_t N>
struct SoughtNodes {
  std::array<int, N> block = {};  ///< By node: its block; -1: it is known.
  std::vector<int> nodes;         ///< By block.

  /// `graph_size`: of the nodes that are sought, see LinksInTime.
  static SoughtNodes Of(const std::array<int, N>& tuple, int graph_size) {
    SoughtNodes sought;
    for (std::size_t k = 0; k < N; ++k) {
      const bool is_sought = tuple[k] < graph_size;
      sought.block[k] = is_sought ? static_cast<int>(sought.nodes.size()) : -1;
      if (is_sought) sought.nodes.push_back(tuple[k]);
    }
    return sought;
  }
};

/// As-rigid-as-possible residual of one directed edge of one frame, Arap, of
/// which one end may be known: its twist is 0.
struct HiddenArap {
  /// Residuals of one edge.
  static constexpr int kResiduals = Arap::kResiduals;
  Arap arap;                 ///< In the world.
  std::array<int, 2> block;  ///< See SoughtNodes.

  /// `twists`: of the ends that are sought.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    const T still[kTwistSize] = {T(0), T(0), T(0), T(0), T(0), T(0)};
    const T* ends[2];
    for (int k = 0; k < 2; ++k) {
      ends[k] = block[k] < 0 ? still : twists[block[k]];
    }
    return arap(ends, residual);
  }
};

/// Second difference in time of the centre of a node, in the world.
///
///   r = sum over three frames of d_k (c_k + tau_k),   c = g + t
///
/// d: 1, -2, 1 of frames that follow one another. Blocks: the twists of the
/// frames in which it is sought, of which tau alone counts. Residual: 3,
/// metres.
struct HiddenSmoothness {
  /// Residuals of one node.
  static constexpr int kResiduals = 3;  // Layout.
  Eigen::Vector3d sum;                  ///< Where all twists are 0.
  std::array<double, 3> differences;    ///< d.
  std::array<int, 3> block;             ///< See SoughtNodes.

  /// `twists`: of the frames in which it is sought.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(sum[d]);
      for (int k = 0; k < 3; ++k) {
        if (block[k] < 0) continue;
        residual[d] += T(differences[k]) * twists[block[k]][3 + d];
      }
    }
    return true;
  }
};

/// Where nodes are, those that are sought and those that are known.
class NodesInTime {
 public:
  /// Both must outlive this.
  NodesInTime(const DeformationGraph& graph, const LinksInTime& links)
      : graph_(graph), links_(links) {}

  /// g, canonical, metres.
  const Eigen::Vector3d& Position(int node) const {
    return node < graph_.size() ? graph_.positions[node]
                                : links_.known_positions[node - graph_.size()];
  }
  /// World from canonical.
  const NodeMotion& Motion(int node) const {
    return node < graph_.size() ? graph_.motions[node]
                                : links_.known_motions[node - graph_.size()];
  }
  /// c = g + t, in the world, metres.
  Eigen::Vector3d Center(int node) const {
    return Position(node) + Motion(node).translation;
  }

 private:
  const DeformationGraph& graph_;
  const LinksInTime& links_;
};

/// Shape of what was hidden: Eq. 6 over the edges of all frames of a window, in
/// each of which an end is sought. Absent outside of RefineHiddenMotions().
class HiddenArapTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.links == nullptr) return;
    const NodesInTime at(input.graph, *input.links);
    std::vector<std::vector<int>> nodes;
    std::vector<HiddenArap> functors;
    for (const std::array<int, 2>& edge : input.links->edges) {
      auto sought = SoughtNodes<2>::Of(edge, input.graph.size());
      const auto [i, j] = edge;
      const Arap arap{at.Center(i), at.Center(j),
                      at.Motion(i).rotation * (at.Position(i) - at.Position(j)),
                      1.0};
      functors.push_back({arap, sought.block});
      nodes.push_back(std::move(sought.nodes));
    }
    sink->AddNodes(nodes, functors);
  }
};

/// Smoothness in time of what was hidden. Absent outside of
/// RefineHiddenMotions().
class HiddenSmoothnessTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    if (input.links == nullptr) return;
    const NodesInTime at(input.graph, *input.links);
    std::vector<std::vector<int>> nodes;
    std::vector<HiddenSmoothness> functors;
    for (std::size_t i = 0; i < input.links->triples.size(); ++i) {
      const std::array<int, 3>& triple = input.links->triples[i];
      const std::array<double, 3>& differences = input.links->differences[i];
      auto sought = SoughtNodes<3>::Of(triple, input.graph.size());
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) sum += differences[k] * at.Center(triple[k]);
      functors.push_back({sum, differences, sought.block});
      nodes.push_back(std::move(sought.nodes));
    }
    sink->AddNodes(nodes, functors);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_HIDDEN_MOTION_H_
