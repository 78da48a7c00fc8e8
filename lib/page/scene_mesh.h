#ifndef SPLITFUSION_LIB_PAGE_SCENE_MESH_H_
#define SPLITFUSION_LIB_PAGE_SCENE_MESH_H_

#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// A mesh with fewer triangles.
struct SmallerMesh {
  TriangleMesh mesh;        ///< Without normals.
  std::vector<int> source;  ///< Index of every vertex in the mesh before.
};

/// The mesh with about `vertices` vertices at most, all of which are vertices
/// of the mesh before: edges whose end changes the surface least are collapsed
/// (quadric error, Garland and Heckbert 1997), as far as its topology lets
/// them. Vertices without a triangle are left out. Neighbours in the order of
/// vertices and triangles are neighbours on the surface, mostly.
SmallerMesh SimplifiedMesh(const TriangleMesh& mesh, int vertices);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_SCENE_MESH_H_
