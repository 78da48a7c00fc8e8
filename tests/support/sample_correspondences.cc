#include "support/sample_correspondences.h"

#include <cmath>
#include <map>
#include <tuple>

#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Makes one of vertices at the same place, so that the parts hang together.
TriangleMesh Welded(const TriangleMesh& mesh) {
  std::map<std::tuple<long, long, long>, int> places;
  std::vector<int> index;
  TriangleMesh welded;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const auto key = [](float x) { return std::lround(x * 1e4f); };
    const auto [place, is_new] =
        places.emplace(std::tuple(key(v.x()), key(v.y()), key(v.z())),
                       static_cast<int>(welded.vertices.size()));
    if (is_new) welded.vertices.push_back(v);
    index.push_back(place->second);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    welded.triangles.emplace_back(index[t[0]], index[t[1]], index[t[2]]);
  }
  welded.normals = ComputeVertexNormals(welded);
  return welded;
}

}  // namespace

std::vector<Correspondence> PerfectAssociation(
    const TriangleMesh& mesh, const DeformationGraph& graph,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& live) {
  const SkinningIndex index(graph, 6);
  const WarpField warp(graph);
  std::vector<Correspondence> correspondences;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Correspondence c;
    c.model.point = mesh.vertices[i];
    c.model.normal = mesh.normals[i];
    c.model.skinning = index.Skin(c.model.point);
    c.warped_normal = warp.WarpNormal(c.model.skinning, c.model.normal);
    c.target = live(c.model.point.cast<double>()).cast<float>();
    c.target_normal = c.warped_normal;
    correspondences.push_back(c);
  }
  return correspondences;
}

std::vector<Correspondence> PlateMovedBy(const Eigen::Vector3d& way) {
  return PerfectAssociation(
      PlateMesh(0.1, 0.1, 0.02, 1), MakeRigidGraph(Rigid3d::Identity()),
      [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + way; });
}

TriangleMesh CornerMesh(double step) {
  constexpr double kSize = 0.2;
  TriangleMesh mesh = PlateMesh(kSize, kSize, step, 1);
  AppendMesh(SheetMesh(kSize, kSize, step,
                       [](double x, double y) {
                         return Eigen::Vector3d(0, y, 1 - x);
                       }),
             &mesh);
  AppendMesh(SheetMesh(kSize, kSize, step,
                       [](double x, double y) {
                         return Eigen::Vector3d(x, 0, 1 - y);
                       }),
             &mesh);
  return Welded(mesh);
}

}  // namespace splitfusion
