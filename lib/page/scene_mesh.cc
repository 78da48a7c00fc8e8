#include "splitfusion/lib/page/scene_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace splitfusion {
namespace {

using Indices = std::vector<unsigned int>;

Indices CornersOf(const TriangleMesh& mesh) {
  Indices corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) corners.push_back(t[k]);
  }
  return corners;
}

/// Collapses edges until about `vertices` vertices are left.
Indices Simplified(const TriangleMesh& mesh, Indices corners, int vertices) {
  // A closed surface has twice as many triangles as vertices.
  const std::size_t target = 6 * static_cast<std::size_t>(vertices);
  if (corners.size() <= target) return corners;
  Indices left(corners.size());
  const float any_error = std::numeric_limits<float>::max();
  left.resize(meshopt_simplify(left.data(), corners.data(), corners.size(),
                               mesh.vertices[0].data(), mesh.vertices.size(),
                               sizeof(Eigen::Vector3f), target, any_error));
  return left;
}

}  // namespace

SmallerMesh SimplifiedMesh(const TriangleMesh& mesh, int vertices) {
  SmallerMesh smaller;
  if (mesh.triangles.empty()) return smaller;
  Indices corners = Simplified(mesh, CornersOf(mesh), vertices);
  meshopt_optimizeVertexCache(corners.data(), corners.data(), corners.size(),
                              mesh.vertices.size());
  Indices place(mesh.vertices.size());
  const std::size_t count = meshopt_optimizeVertexFetchRemap(
      place.data(), corners.data(), corners.size(), mesh.vertices.size());
  smaller.source.resize(count);
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < count) smaller.source[place[i]] = static_cast<int>(i);
  }
  for (const int i : smaller.source) {
    smaller.mesh.vertices.push_back(mesh.vertices[i]);
    if (!mesh.colors.empty()) smaller.mesh.colors.push_back(mesh.colors[i]);
  }
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    smaller.mesh.triangles.emplace_back(
        place[corners[i]], place[corners[i + 1]], place[corners[i + 2]]);
  }
  return smaller;
}

}  // namespace splitfusion
