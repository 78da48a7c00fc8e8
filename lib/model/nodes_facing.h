#ifndef SPLITFUSION_LIB_MODEL_NODES_FACING_H_
#define SPLITFUSION_LIB_MODEL_NODES_FACING_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/mesh_skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Of every node whether the surface about it faces the camera: the mean normal
/// of the vertices that it is nearest to, turned as it is. `mesh`: canonical;
/// `supports`: of its vertices. One that is nearest to none does not.
std::vector<char> NodesFacing(const TriangleMesh& mesh,
                              const std::vector<SkinningSupport>& supports,
                              const DeformationGraph& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_NODES_FACING_H_
