#ifndef SPLITFUSION_LIB_MODEL_SURFACE_PARTS_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_PARTS_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// A part of a surface.
struct SurfacePart {
  TriangleMesh mesh;        ///< Canonical frame, metres.
  DeformationGraph graph;   ///< Of its nodes.
  std::vector<char> nodes;  ///< Of every one of the surface whether it is.
};

/// What some nodes of a surface carry: the triangles with a vertex whose
/// nearest node is one of `of_nodes` (of every node whether it is), and those
/// beside them. They are apart by how many frames before `now` their nodes were
/// seen first (DeformationGraph::first_seen), by powers of four, and carried by
/// these alone: what is kept of a part are the motions of its nodes since the
/// first of them was seen, so that of every node there are as many as there are
/// frames in which it was in use, up to that factor. Nodes that were never seen
/// carry none.
///
/// `skinning`: of the mesh's vertices by `graph`.
std::vector<SurfacePart> PartsOf(const TriangleMesh& mesh,
                                 const MeshSkinning& skinning,
                                 const DeformationGraph& graph,
                                 const std::vector<char>& of_nodes, int now);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_PARTS_H_
