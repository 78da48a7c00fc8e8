#include "splitfusion/lib/visibility/seen_edges.h"

#include <algorithm>

namespace splitfusion {

void KeepSeenEdges(const MotionHistory& history,
                   const std::vector<int>& last_seen, DeformationGraph* graph) {
  graph->seen_edges.resize(graph->size());
  for (int i = 0; i < graph->size(); ++i) {
    std::vector<Eigen::Vector3d>& edges = graph->seen_edges[i];
    edges.clear();
    for (const int j : graph->neighbors[i]) {
      const std::vector<NodeMotion>& motions =
          history.frames[std::min(last_seen[i], last_seen[j])].motions;
      edges.push_back(motions[i].rotation.transpose() *
                      (graph->positions[i] + motions[i].translation -
                       graph->positions[j] - motions[j].translation));
    }
  }
}

}  // namespace splitfusion
