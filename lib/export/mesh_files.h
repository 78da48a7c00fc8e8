#ifndef SPLITFUSION_LIB_EXPORT_MESH_FILES_H_
#define SPLITFUSION_LIB_EXPORT_MESH_FILES_H_

#include <string>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Writes a mesh as Wavefront OBJ, metres: `v x y z r g b` (colours 0..1, where
/// there are any), `vn`, and triangles `f i//i`; vertices in their order.
///
/// @throw InputError if the file cannot be written.
void WriteObj(const std::string& path, const TriangleMesh& mesh);

/// Writes the vertices of a mesh as binary PCD 0.7, fields x, y, z, normal_x,
/// normal_y, normal_z and rgb as PCL packs it, as far as the mesh has them.
///
/// @throw InputError if the file cannot be written.
void WritePcd(const std::string& path, const TriangleMesh& mesh);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_MESH_FILES_H_
