#include "splitfusion/lib/model/surface_model.h"

#include <algorithm>
#include <limits>

namespace splitfusion {
namespace {

/// Between canonical frames, metres; more than a node reaches.
constexpr double kGap = 1;  // Layout.

/// Extent along x of a model's nodes and vertices, metres.
struct Extent {
  explicit Extent(const SurfaceModel& model) {
    for (const Eigen::Vector3d& g : model.graph.positions) Add(g.x());
    for (const Eigen::Vector3f& v : model.mesh.vertices) Add(v.x());
  }

  void Add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }

  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

void AppendMesh(const TriangleMesh& mesh, double shift, TriangleMesh* joined) {
  const int first = static_cast<int>(joined->vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    joined->vertices.push_back(
        v + Eigen::Vector3f(static_cast<float>(shift), 0, 0));
  }
  joined->normals.insert(joined->normals.end(), mesh.normals.begin(),
                         mesh.normals.end());
  joined->colors.insert(joined->colors.end(), mesh.colors.begin(),
                        mesh.colors.end());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    joined->triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
}

void AppendGraph(const SurfaceModel& model, double shift,
                 DeformationGraph* joined) {
  const DeformationGraph& graph = model.graph;
  const int first_node = joined->size();
  const int first_frame = model.history.frames.front().frame;
  joined->models.push_back({first_node, first_frame});
  joined->node_spacing = std::max(joined->node_spacing, graph.node_spacing);
  for (int i = 0; i < graph.size(); ++i) {
    joined->positions.push_back(graph.positions[i] +
                                Eigen::Vector3d(shift, 0, 0));
    joined->neighbors.push_back(graph.neighbors[i]);
    for (int& j : joined->neighbors.back()) j += first_node;
    const bool known = i < static_cast<int>(graph.first_seen.size());
    joined->first_seen.push_back(known ? graph.first_seen[i] : first_frame);
  }
}

/// Motions of a model in a frame, or in the nearest one that it has, for nodes
/// that were moved by `shift` along x.
std::vector<NodeMotion> MotionsAt(const SurfaceModel& model, int frame,
                                  double shift) {
  const std::vector<FrameMotions>& frames = model.history.frames;
  auto found = std::lower_bound(
      frames.begin(), frames.end(), frame,
      [](const FrameMotions& item, int index) { return item.frame < index; });
  if (found == frames.end()) --found;
  std::vector<NodeMotion> motions = found->motions;
  for (NodeMotion& motion : motions) motion.translation.x() -= shift;
  return motions;
}

}  // namespace

SurfaceModel JoinModels(const std::vector<const SurfaceModel*>& models) {
  if (models.size() == 1) return *models.front();
  SurfaceModel joined;
  std::vector<double> shifts;
  double end = 0;
  for (const SurfaceModel* model : models) {
    const Extent extent(*model);
    shifts.push_back(shifts.empty() ? 0 : end + kGap - extent.low);
    end = extent.high + shifts.back();
    AppendMesh(model->mesh, shifts.back(), &joined.mesh);
    AppendGraph(*model, shifts.back(), &joined.graph);
  }
  for (const SurfaceModel* model : models) {
    for (const FrameMotions& frame : model->history.frames) {
      FrameMotions all{frame.frame, frame.tracked, {}};
      for (std::size_t i = 0; i < models.size(); ++i) {
        const auto motions = MotionsAt(*models[i], frame.frame, shifts[i]);
        all.motions.insert(all.motions.end(), motions.begin(), motions.end());
      }
      joined.history.frames.push_back(std::move(all));
    }
  }
  joined.graph.motions = joined.history.frames.back().motions;
  return joined;
}

}  // namespace splitfusion
