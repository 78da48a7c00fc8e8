#ifndef SPLITFUSION_LIB_GEOMETRY_MESH_PIECES_H_
#define SPLITFUSION_LIB_GEOMETRY_MESH_PIECES_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Leaves out of a mesh every piece (triangles that hang together by common
/// vertices) of less than `min_area` square metres, and vertices of no
/// triangle. The order of what stays does not change. The largest piece always
/// stays.
TriangleMesh WithoutSmallPieces(const TriangleMesh& mesh, double min_area);

/// The triangles that WithoutSmallPieces() keeps, by the vertices of `mesh`.
std::vector<Eigen::Vector3i> TrianglesOfLargePieces(const TriangleMesh& mesh,
                                                    double min_area);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_MESH_PIECES_H_
