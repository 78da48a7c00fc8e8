#ifndef SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_

#include <map>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// What is kept of a surface: its shape, and how it moved.
struct SurfaceModel {
  TriangleMesh mesh;       ///< Canonical frame, metres.
  DeformationGraph graph;  ///< Its motions are those of the last frame.
  MotionHistory history;   ///< Motions of all its frames.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mesh, graph, history);
  }
};

/// What is kept of every surface, by id.
using SurfaceModels = std::map<int, SurfaceModel>;

/// The part of a surface that some nodes carry: the triangles with a vertex
/// whose nearest node is one of `nodes` (of every node whether it is), those
/// beside them, what Eq. 3 needs for them, and their history, from the frame on
/// in which any of it was first seen. `supports`: of the mesh's vertices.
SurfaceModel PartOf(const TriangleMesh& mesh,
                    const std::vector<SkinningSupport>& supports,
                    const DeformationGraph& graph, const MotionHistory& history,
                    const std::vector<char>& nodes);

/// One model out of the parts of a surface; the last one is in use to the end,
/// the others, which were refuted or replaced (Surface::Reanchor), in the
/// frames of their histories, see DeformationGraph::parts. Their canonical
/// frames are laid beside one another along x, a metre apart, so that Eq. 3
/// finds the nodes of one part only. In other frames their nodes keep the
/// nearest motion that they had.
SurfaceModel JoinModels(const std::vector<const SurfaceModel*>& models);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
