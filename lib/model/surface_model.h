#ifndef SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_

#include <map>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

struct TrackedModel;

/// What is kept of a surface: its shape, and how it moved.
struct SurfaceModel {
  TriangleMesh mesh;       ///< Canonical frame, metres.
  DeformationGraph graph;  ///< Its motions are the last ones.
  MotionHistory history;   ///< Motions of all its frames.
};

/// What is kept of every surface, by id.
using SurfaceModels = std::map<int, SurfaceModel>;

/// One model out of the parts of a surface; the last one is in use to the end,
/// the others, which were refuted or replaced (Surface::Reanchor), in the
/// frames of their histories, see DeformationGraph::parts. Their canonical
/// frames are laid apart, a metre or more, in the cells of a cube, so that Eq.
/// 3 finds the nodes of one part only. In other frames their nodes have no
/// motion; those of the graph are the last ones that they had. A single model
/// stays as it is. Not all frames are in memory at a time.
///
/// @throw InputError if temporary files cannot be read or written.
SurfaceModel JoinModels(std::vector<TrackedModel> models);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_MODEL_H_
