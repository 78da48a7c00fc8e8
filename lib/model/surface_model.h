#ifndef SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_

#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"
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

/// One model out of those that a surface had one after the other
/// (Surface::Reanchor); each is in use from its first frame until the next one
/// begins, see DeformationGraph::models. Their canonical frames are laid beside
/// one another along x, a metre apart, so that Eq. 3 finds the nodes of one
/// model only. In frames of other models their nodes keep the nearest motion
/// that they had.
SurfaceModel JoinModels(const std::vector<const SurfaceModel*>& models);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
