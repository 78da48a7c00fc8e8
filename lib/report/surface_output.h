#ifndef SPLITFUSION_LIB_REPORT_SURFACE_OUTPUT_H_
#define SPLITFUSION_LIB_REPORT_SURFACE_OUTPUT_H_

#include <string>

#include "splitfusion/lib/geometry/stretched_area.h"
#include "splitfusion/lib/model/surface.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// Which warped meshes are written.
struct WarpedOutput {
  int every = 10;      ///< Flag: of every n-th frame; 0 = none.
  bool whole = false;  ///< With what was seen only later.
};

/// Writes warped/FRAME.ply of RUN/surfaces/NNN_LABEL for every
/// `warped.every`-th frame since the surface's birth (0 = none): the final mesh
/// carried into that frame's camera, so that vertex i is the same surface point
/// in all of them; unless `warped.whole`, with no more than had been seen by
/// then (SeenTriangles), and without triangles that are stretched. Returns what
/// there was of these in all warped meshes together.
///
/// `id`, `label`: of the surface; `neighbors`: K of Eq. 3.
/// @throw InputError if a file cannot be written.
StretchedArea WriteWarpedMeshes(const RunPaths& paths, int id,
                                const std::string& label,
                                const SurfaceModel& model, int neighbors,
                                const WarpedOutput& warped);

/// Writes RUN/surfaces/NNN_LABEL/{mesh.ply, tsdf.vdb, graph.json, motions.bin}
/// and, unless the surface is the rigid background, the warped meshes, see
/// there. The mesh must be up to date.
///
/// `model`: that of the surface, Surface::Model(), with its final motions.
/// @throw InputError if a file cannot be written.
StretchedArea WriteSurface(const RunPaths& paths, const Surface& surface,
                           const SurfaceModel& model,
                           const WarpedOutput& warped);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_SURFACE_OUTPUT_H_
