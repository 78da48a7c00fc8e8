#ifndef SPLITFUSION_LIB_EXPORT_RUN_ARRAYS_H_
#define SPLITFUSION_LIB_EXPORT_RUN_ARRAYS_H_

#include <string>

#include "splitfusion/lib/export/export_scene.h"

namespace splitfusion {

/// Writes a run as arrays for NumPy (WriteNpz()). Of F frames: `frames`,
/// `timestamps` (s), `world_from_camera` (F x 4 x 4), `intrinsics` (fx, fy, cx,
/// cy, width, height). Of each surface, below `SURFACE/`, with N nodes, V
/// vertices and the M frames in which it is there: `vertices`, `normals`,
/// `colors`, `triangles`, `source` (index in mesh.ply), `nodes` and `weights`
/// (V x K, Eq. 3), `positions` (g, N x 3), `edges` (pairs of nodes), `frames`
/// (M), `tracked` (M), `rotations` (R, M x N x 3 x 3), `translations` (t,
/// M x N x 3) and `centers` (mean of the vertices, M x 3).
///
/// @throw InputError if the file cannot be written.
void WriteRunArrays(const std::string& path, const ExportScene& scene);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_RUN_ARRAYS_H_
