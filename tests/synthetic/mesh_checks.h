#ifndef SPLITFUSION_TESTS_SYNTHETIC_MESH_CHECKS_H_
#define SPLITFUSION_TESTS_SYNTHETIC_MESH_CHECKS_H_

#include <Eigen/Geometry>
#include <map>
#include <utility>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// True if every directed edge occurs once and its opposite too: a closed,
/// consistently oriented, manifold surface.
inline bool IsClosed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count != 1 || opposite == edges.end()) return false;
  }
  return !edges.empty();
}

/// Volume inside a closed mesh, positive if triangles face outwards; m^3.
inline double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    volume +=
        mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return volume / 6;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SYNTHETIC_MESH_CHECKS_H_
