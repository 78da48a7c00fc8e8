#ifndef SPLITFUSION_LIB_VISIBILITY_SEEN_TRIANGLES_H_
#define SPLITFUSION_LIB_VISIBILITY_SEEN_TRIANGLES_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// The part of a surface's final mesh that had been seen by a frame: triangles
/// whose corners lie near nodes that had been (DeformationGraph::first_seen),
/// wherever they are by now, and all where that is not recorded. What
/// nodes carry that are not in use in the frame is left out.
///
/// A node is near as far as the node spacing: so far the graph did not grow. At
/// GraphOptions::max_nodes it does not grow until nodes are forgotten, and what
/// is new is near an old node, however far away.
///
/// Motions carry every vertex to every frame, but those of a node before it
/// was made are only blended from the nodes around it: an arm that came into
/// view raised would stick out, raised and in free space, in all frames before.
///
/// `mesh` canonical, metres; `skinning`: of its vertices by the nodes of
/// `graph`.
std::vector<Eigen::Vector3i> SeenTriangles(
    const TriangleMesh& mesh, const std::vector<Skinning>& skinning,
    const DeformationGraph& graph, int frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_SEEN_TRIANGLES_H_
