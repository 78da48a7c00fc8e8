#include "splitfusion/lib/geometry/mesh_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <vector>

namespace splitfusion {
namespace {

/// Disjoint sets of vertices.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0);
  }
  int Find(int i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void Join(int a, int b) { parents_[Find(a)] = Find(b); }

 private:
  std::vector<int> parents_;
};

float Area(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return 0.5f * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

/// Area of the piece that each vertex stands for; 0 if for none.
std::vector<double> PieceAreas(const TriangleMesh& mesh, Pieces* pieces) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    pieces->Join(t[0], t[1]);
    pieces->Join(t[1], t[2]);
  }
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    areas[pieces->Find(t[0])] += Area(mesh, t);
  }
  return areas;
}

}  // namespace

TriangleMesh WithoutSmallPieces(const TriangleMesh& mesh, double min_area) {
  Pieces pieces(mesh.vertices.size());
  const std::vector<double> areas = PieceAreas(mesh, &pieces);
  if (areas.empty()) return mesh;
  const double limit =
      std::min(min_area, *std::max_element(areas.begin(), areas.end()));
  TriangleMesh kept;
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const double area = areas[pieces.Find(static_cast<int>(i))];
    if (area < limit || area == 0) continue;
    new_index[i] = static_cast<int>(kept.vertices.size());
    kept.vertices.push_back(mesh.vertices[i]);
    if (!mesh.normals.empty()) kept.normals.push_back(mesh.normals[i]);
    if (!mesh.colors.empty()) kept.colors.push_back(mesh.colors[i]);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (new_index[t[0]] < 0) continue;
    kept.triangles.emplace_back(new_index[t[0]], new_index[t[1]],
                                new_index[t[2]]);
  }
  return kept;
}

}  // namespace splitfusion
