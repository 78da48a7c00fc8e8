#ifndef SPLITFUSION_PIPELINES_POSE_GRAPH_H_
#define SPLITFUSION_PIPELINES_POSE_GRAPH_H_

#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/typical_points.h"

namespace splitfusion {

/// A measured motion between two poses.
struct PoseEdge {
  int from = 0;               ///< Index of a pose.
  int to = 0;                 ///< Likewise.
  Rigid3d motion;             ///< Frame `to` from frame `from`, metres.
  TypicalPoints points;       ///< What frame `from` shows, metres.
  bool may_be_wrong = false;  ///< Left out if the others contradict it.
};

/// How far poses (camera from world) are from an edge: root mean square over
/// its points, metres.
double Contradiction(const std::vector<Rigid3d>& poses, const PoseEdge& edge);

/// The poses, camera from world, that agree best with all edges (RelativePose)
/// that hold, starting from `poses`, of which the first stays. Edges that may
/// be wrong have Tukey's loss, the others Huber's, of width `distance`, metres;
/// by graduated non-convexity (Blake and Zisserman 1987): Tukey's first takes
/// all edges in, and gets narrower by halves.
///
/// @throw std::runtime_error if there is no usable solution.
std::vector<Rigid3d> SolvePoseGraph(std::vector<Rigid3d> poses,
                                    const std::vector<PoseEdge>& edges,
                                    double distance);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_POSE_GRAPH_H_
