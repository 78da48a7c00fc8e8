#ifndef SPLITFUSION_TESTS_PIPELINES_TRACKING_SCENES_H_
#define SPLITFUSION_TESTS_PIPELINES_TRACKING_SCENES_H_

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/pipelines/surface_tracker.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {

/// 320x240 pixels.
inline PinholeCamera Camera() {
  PinholeCamera camera = SmallCamera();
  camera.width *= 2, camera.height *= 2;
  camera.fx *= 2, camera.fy *= 2, camera.cx *= 2, camera.cy *= 2;
  return camera;
}

inline LiveView View(const cv::Mat_<float>& depth) {
  return MakeLiveView(Camera(), depth, PlainColor(Camera(), {90, 90, 90}));
}

/// Depth of three slanted planes that meet like those of a room's corner.
inline cv::Mat_<float> CornerDepth(const Rigid3d& camera_from_world) {
  const std::vector<std::pair<Eigen::Vector3d, double>> planes = {
      {Eigen::Vector3d(0.2, 0, 1).normalized(), 1.5},
      {{-0.6, 0, 0.8}, 1.15},
      {{0, 0.6, 0.8}, 1.1}};
  cv::Mat_<float> nearest(Camera().height, Camera().width, 9.f);
  for (const auto& [n, d] : planes) {
    const Eigen::Vector3d moved = camera_from_world.linear() * n;
    cv::Mat_<float> depth = PlaneDepth(
        Camera(), moved, d + moved.dot(camera_from_world.translation()));
    depth.setTo(9, depth <= 0);
    nearest = cv::min(nearest, depth);
  }
  return nearest;
}

/// The live points as a model in the camera frame, carried by one node.
inline std::vector<ModelSample> SamplesOf(const LiveView& view,
                                          int surface = 0) {
  std::vector<ModelSample> samples;
  for (int v = 0; v < view.depth.rows; v += 2) {
    for (int u = 0; u < view.depth.cols; u += 2) {
      const cv::Vec3f& p = view.map.points(v, u);
      const cv::Vec3f& n = view.map.normals(v, u);
      if (n[2] == 0 || view.labels(v, u) != surface) continue;
      ModelSample sample;
      sample.point = {p[0], p[1], p[2]};
      sample.normal = {n[0], n[1], n[2]};
      sample.u = u, sample.v = v;
      sample.skinning.count = 1;
      sample.skinning.weights[0] = 1;
      samples.push_back(sample);
    }
  }
  return samples;
}

/// A tracker with the paper's terms and those of `terms`.
inline SurfaceTracker MakeTracker(const TrackerOptions& options = {},
                                  const std::string& further_terms = "",
                                  const TermRegistry& terms = BuiltinTerms()) {
  return SurfaceTracker(
      options, SolverOptions(),
      ParseEnergy("point_to_plane(loss=tukey,scale=0.03) arap(weight=8) " +
                      further_terms,
                  terms));
}

/// A wavy sheet that does not slide along itself, and the view of it bent.
struct BendingSheet {
  BendingSheet() {
    const auto waves = [](double x, double y) {
      return Eigen::Vector3d(x - 0.25, y - 0.2,
                             1 + 0.03 * std::sin(14 * x) * std::cos(16 * y));
    };
    const TriangleMesh rest = SheetMesh(0.5, 0.4, 0.01, waves);
    graph = CoverWithNodes(rest, 0.04);
    const SkinningIndex index(graph, 6);
    samples = SamplesOf(View(MeshDepth(Camera(), rest)));
    for (ModelSample& s : samples) s.skinning = index.Skin(s.point);
    live = View(
        MeshDepth(Camera(), SheetMesh(0.5, 0.4, 0.01, [&](double x, double y) {
                    return Bent(waves(x, y));
                  })));
  }
  static Eigen::Vector3d Bent(const Eigen::Vector3d& p) {
    return Bend(p, 1, 0.8);
  }

  DeformationGraph graph;
  std::vector<ModelSample> samples;
  LiveView live;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_PIPELINES_TRACKING_SCENES_H_
