#include "splitfusion/lib/deformation/seen_edges.h"

#include <algorithm>
#include <cmath>

namespace splitfusion {
namespace {

/// c_i - c_j in the frame of node i, c = g + t.
Eigen::Vector3d EdgeIn(const std::vector<NodeMotion>& motions,
                       const DeformationGraph& graph, int i, int j) {
  return motions[i].rotation.transpose() *
         (graph.positions[i] + motions[i].translation - graph.positions[j] -
          motions[j].translation);
}

}  // namespace

void KeepSeenEdges(const MotionHistory& history,
                   const std::vector<int>& last_seen, DeformationGraph* graph) {
  const int now = static_cast<int>(history.frames.size()) - 1;
  graph->seen_edges.resize(graph->size());
  for (int i = 0; i < graph->size(); ++i) {
    std::vector<Eigen::Vector3d>& edges = graph->seen_edges[i];
    edges.clear();
    for (const int j : graph->neighbors[i]) {
      const int seen = std::min(last_seen[i], last_seen[j]);
      const double kept = std::exp2((seen - now) / kSeenEdgeHalfLife);
      const Eigen::Vector3d rest = graph->positions[i] - graph->positions[j];
      edges.push_back(
          rest +
          kept * (EdgeIn(history.frames[seen].motions, *graph, i, j) - rest));
    }
  }
}

}  // namespace splitfusion
