#ifndef SPLITFUSION_LIB_DEFORMATION_SEEN_EDGES_H_
#define SPLITFUSION_LIB_DEFORMATION_SEEN_EDGES_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"

namespace splitfusion {

/// Frames after which an edge that is not seen is half of the way back from how
/// it was seen to its rest shape: a leg that swings behind the other one is
/// kept as it was, what was not seen for long may be anywhere.
constexpr double kSeenEdgeHalfLife = 6;

/// Writes DeformationGraph::seen_edges: every edge as it was in the last frame
/// in which both of its nodes had been seen (the earlier one of the frames that
/// each was last seen in), the farther back the nearer to its rest shape,
///
///   e_ij = g_i - g_j + 2^(-age / half-life) [R_i^T (c_i - c_j) - (g_i - g_j)],
///
/// c = g + t, with the motions of that frame.
///
/// `last_seen`: for every node, the place in `history.frames` of the last frame
/// that showed it. Every frame of `history` has a motion of every node.
void KeepSeenEdges(const MotionHistory& history,
                   const std::vector<int>& last_seen, DeformationGraph* graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SEEN_EDGES_H_
