#ifndef SPLITFUSION_TESTS_RENDER_PLATE_VIEWS_H_
#define SPLITFUSION_TESTS_RENDER_PLATE_VIEWS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/model/surface_model.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {

using Color = std::array<std::uint8_t, 3>;

constexpr int kPlateSurface = 3;
constexpr Color kFused = {10, 20, 30};

/// A plate of 30 by 20 cm amid the view at 1 m.
inline SurfaceModel Plate(double step = 0.025) {
  SurfaceModel model;
  model.mesh = PlateMesh(0.3, 0.2, step, 1);
  for (Eigen::Vector3f& v : model.mesh.vertices) {
    v -= Eigen::Vector3f(0.15f, 0.1f, 0);
  }
  model.mesh.normals = ComputeVertexNormals(model.mesh);
  model.mesh.colors.assign(model.mesh.vertices.size(), kFused);
  model.graph = CoverWithNodes(model.mesh, 0.05);
  return model;
}

/// Moves the plate in a frame, in which all of it is seen.
inline void AddFrame(int frame, const Rigid3d& motion, SurfaceModel* model) {
  DeformationGraph graph = model->graph;
  ApplyRigidMotion(motion, &graph);
  model->history.Append(
      {frame, true, graph.motions, std::vector<char>(graph.size(), true)});
}

/// A view of one colour, all of whose pixels show the surface.
inline LiveView View(const cv::Mat_<float>& depth, const cv::Vec3b& bgr) {
  LiveView live =
      MakeLiveView(SmallCamera(), depth, PlainColor(SmallCamera(), bgr));
  live.labels.setTo(kPlateSurface);
  return live;
}

/// What the camera sees of the plate in a frame, before a wall, all in one
/// colour.
inline LiveView See(const SurfaceModel& model, std::size_t index,
                    const cv::Vec3b& bgr) {
  DeformationGraph graph = model.graph;
  graph.motions = model.history.At(index).motions;
  const WarpField warp(graph);
  const SkinningIndex skinning(graph, 4);
  TriangleMesh mesh = model.mesh;
  for (Eigen::Vector3f& v : mesh.vertices) {
    v = warp.WarpPoint(skinning.Skin(v), v);
  }
  const PinholeCamera camera = SmallCamera();
  cv::Mat_<float> depth = MeshDepth(camera, mesh);
  depth.setTo(3, depth == 0);
  return View(depth, bgr);
}

inline Rigid3d Away(double metres) {
  return MakeMotion({0, 0, 0}, {0, 0, metres});
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_RENDER_PLATE_VIEWS_H_
