#ifndef SPLITFUSION_LIB_EXPORT_GLTF_MESH_H_
#define SPLITFUSION_LIB_EXPORT_GLTF_MESH_H_

#include <nlohmann/json.hpp>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/export/glb_file.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Adds the arrays of a mesh; returns it as a `primitive` of glTF, of material
/// 0. Colours become linear, as glTF has them.
///
/// @throw InputError if the file becomes too large; so below.
nlohmann::ordered_json AddPrimitive(const TriangleMesh& mesh, GlbFile* file);

/// Gives the vertices of a primitive their nodes and weights, at most four in a
/// set.
void AddSkinning(const std::vector<Skinning>& skinning, GlbFile* file,
                 nlohmann::ordered_json* primitive);

/// Gives the vertices of a primitive their indices in mesh.ply, as the
/// attribute `_VERTEX`.
void AddSource(const std::vector<int>& source, GlbFile* file,
               nlohmann::ordered_json* primitive);

/// Gives a primitive a shape to morph to: differences of `mesh` from `base`.
void AddTarget(const TriangleMesh& base, const TriangleMesh& mesh,
               GlbFile* file, nlohmann::ordered_json* primitive);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_GLTF_MESH_H_
