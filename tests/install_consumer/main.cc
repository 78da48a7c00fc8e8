// A user's program: renders a mesh, minimises an energy with a term of its own
// and opens a volume, all with the installed library.

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/render/rasterizer.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace {

/// Distance of a warped model point to its live point, r = x - v_t.
struct PointToPoint {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d target;  ///< v_t, camera frame, metres.

  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d] - T(target[d]);
    return true;
  }
};

/// A user's term over all correspondences; CONTRIBUTING.md shows it too.
class PointToPointTerm : public splitfusion::EnergyTerm {
 public:
  void AddResiduals(const splitfusion::EnergyInput& input,
                    splitfusion::ResidualSink* sink) const override {
    std::vector<const splitfusion::ModelSample*> samples;
    std::vector<PointToPoint> functors;
    for (const splitfusion::Correspondence& c : input.correspondences) {
      samples.push_back(&c.model);
      functors.push_back({c.target.cast<double>()});
    }
    sink->AddWarpedPoints(samples, functors);
  }
};

splitfusion::PinholeCamera Camera() {
  splitfusion::PinholeCamera camera;
  camera.width = 32;
  camera.height = 24;
  camera.fx = camera.fy = 30;
  camera.cx = 15.5;
  camera.cy = 11.5;
  return camera;
}

/// Depth of a square of 2 m at z = 2 m that faces the camera, in its middle.
float RenderSquare() {
  splitfusion::TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  splitfusion::Raster raster;
  raster.Clear(Camera());
  splitfusion::RasterizeTriangles(mesh.vertices, mesh.triangles, Camera(),
                                  /*cull_back_faces=*/true,
                                  /*first_triangle_id=*/0, &raster);
  return raster.depth(12, 16);
}

/// Corners of a box, and where a motion takes them.
std::vector<splitfusion::Correspondence> MovedBox(
    const splitfusion::Rigid3d& motion) {
  std::vector<splitfusion::Correspondence> correspondences(8);
  for (int i = 0; i < 8; ++i) {
    splitfusion::Correspondence& c = correspondences[i];
    c.model.point = {0.3f * (i & 1), 0.2f * (i >> 1 & 1), 1 + 0.1f * (i >> 2)};
    c.model.skinning.count = 1;
    c.model.skinning.weights[0] = 1;
    c.target = motion.cast<float>() * c.model.point;
  }
  return correspondences;
}

/// How far the motion found with the user's term is from the true one, metres
/// and radians.
double MotionError() {
  splitfusion::TermRegistry terms = splitfusion::BuiltinTerms();
  terms.Register("to_live_point",
                 [] { return std::make_unique<PointToPointTerm>(); });
  const splitfusion::Energy energy =
      splitfusion::ParseEnergy("to_live_point(weight=2)", terms);
  splitfusion::Rigid3d motion = splitfusion::Rigid3d::Identity();
  motion.linear() = splitfusion::ExpSo3({0.1, -0.2, 0.05});
  motion.translation() << 0.1, -0.2, 0.3;
  splitfusion::DeformationGraph graph =
      splitfusion::MakeRigidGraph(splitfusion::Rigid3d::Identity());
  splitfusion::SolverOptions options;
  options.solver = "ceres";
  options.max_iterations = 20;
  splitfusion::Minimize({energy, MovedBox(motion), Camera()}, options, &graph);
  const splitfusion::Rigid3d found = splitfusion::MeanRigidMotion(graph);
  return (found.matrix() - motion.matrix()).norm();
}

int Check(bool ok, const char* what, double value) {
  std::printf("%s: %.6f %s\n", what, value, ok ? "ok" : "WRONG");
  return ok ? 0 : 1;
}

}  // namespace

int main() {
  const float depth = RenderSquare();
  const double error = MotionError();
  const splitfusion::TsdfVolume volume({/*voxel_size=*/0.02,
                                        /*truncation=*/0.08,
                                        /*max_weight=*/64});
  return Check(std::abs(depth - 2) < 1e-3, "depth of the square, m", depth) +
         Check(error < 1e-5, "error of the motion", error) +
         Check(volume.options().voxel_size == 0.02, "voxel, m",
               volume.options().voxel_size);
}
