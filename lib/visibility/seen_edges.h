#ifndef SPLITFUSION_LIB_VISIBILITY_SEEN_EDGES_H_
#define SPLITFUSION_LIB_VISIBILITY_SEEN_EDGES_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"

namespace splitfusion {

/// Writes DeformationGraph::seen_edges: every edge as it was in the last frame
/// in which both of its nodes had been seen, which is taken for the earlier one
/// of the frames that each was last seen in.
///
/// `last_seen`: for every node, the place in `history.frames` of the last frame
/// that showed it. Every frame of `history` has a motion of every node.
void KeepSeenEdges(const MotionHistory& history,
                   const std::vector<int>& last_seen, DeformationGraph* graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_SEEN_EDGES_H_
