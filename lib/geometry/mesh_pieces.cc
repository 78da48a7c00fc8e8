#include "splitfusion/lib/geometry/mesh_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <numeric>

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

/// Of every vertex whether it is of a piece that stays.
std::vector<char> InLargePieces(const TriangleMesh& mesh, double min_area) {
  Pieces pieces(mesh.vertices.size());
  const std::vector<double> areas = PieceAreas(mesh, &pieces);
  std::vector<char> large(areas.size());
  if (areas.empty()) return large;
  const double limit =
      std::min(min_area, *std::max_element(areas.begin(), areas.end()));
  for (std::size_t i = 0; i < large.size(); ++i) {
    const double area = areas[pieces.Find(static_cast<int>(i))];
    large[i] = area >= limit && area > 0;
  }
  return large;
}

}  // namespace

TriangleMesh WithoutSmallPieces(const TriangleMesh& mesh, double min_area) {
  const std::vector<char> large = InLargePieces(mesh, min_area);
  TriangleMesh kept;
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (large[i] == 0) continue;
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

std::vector<Eigen::Vector3i> TrianglesOfLargePieces(const TriangleMesh& mesh,
                                                    double min_area) {
  const std::vector<char> large = InLargePieces(mesh, min_area);
  std::vector<Eigen::Vector3i> kept;
  std::copy_if(mesh.triangles.begin(), mesh.triangles.end(),
               std::back_inserter(kept),
               [&](const Eigen::Vector3i& t) { return large[t[0]] != 0; });
  return kept;
}

}  // namespace splitfusion
