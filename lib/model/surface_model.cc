#include "splitfusion/lib/model/surface_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "splitfusion/lib/model/retired_models.h"

namespace splitfusion {
namespace {

/// Between canonical frames, metres; more than a node reaches.
constexpr double kGap = 1;  // Layout.

using Box = Eigen::AlignedBox3d;

/// Of a model's nodes and vertices, canonical frame, metres.
Box ExtentOf(const TrackedModel& model) {
  Box box;
  for (const Eigen::Vector3d& g : model.graph.positions) box.extend(g);
  for (const Eigen::Vector3f& v : model.mesh.vertices) {
    box.extend(v.cast<double>());
  }
  return box;
}

/// Where canonical frames are moved so that they lie in the cells of a cube,
/// the first one where it is: in a row thousands of them would reach so far
/// that single precision rounds to millimetres.
std::vector<Eigen::Vector3d> ShiftsOf(const std::vector<TrackedModel>& models) {
  std::vector<Box> boxes;
  double width = 0;
  for (const TrackedModel& model : models) {
    boxes.push_back(ExtentOf(model));
    width = std::max(width, boxes.back().sizes().maxCoeff());
  }
  std::size_t side = 1;
  while (side * side * side < models.size()) ++side;
  std::vector<Eigen::Vector3d> shifts;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Eigen::Vector3d cell(static_cast<double>(i % side),
                               static_cast<double>(i / side % side),
                               static_cast<double>(i / side / side));
    shifts.push_back((width + kGap) * cell + boxes[0].min() - boxes[i].min());
  }
  return shifts;
}

void AppendMesh(const TriangleMesh& mesh, const Eigen::Vector3d& shift,
                TriangleMesh* joined) {
  const int first = static_cast<int>(joined->vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    joined->vertices.push_back(v + shift.cast<float>());
  }
  joined->normals.insert(joined->normals.end(), mesh.normals.begin(),
                         mesh.normals.end());
  joined->colors.insert(joined->colors.end(), mesh.colors.begin(),
                        mesh.colors.end());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    joined->triangles.push_back(t + Eigen::Vector3i::Constant(first));
  }
}

void AppendGraph(const TrackedModel& model, const Eigen::Vector3d& shift,
                 DeformationGraph* joined) {
  const DeformationGraph& graph = model.graph;
  const int first_node = joined->size();
  const MotionLog& frames = model.history;
  const int first_frame = frames.frame(0);
  joined->parts.push_back(
      {first_node, first_frame, frames.frame(frames.size() - 1) + 1});
  joined->node_spacing = std::max(joined->node_spacing, graph.node_spacing);
  for (int i = 0; i < graph.size(); ++i) {
    joined->positions.push_back(graph.positions[i] + shift);
    joined->neighbors.push_back(graph.neighbors[i]);
    for (int& j : joined->neighbors.back()) j += first_node;
    const bool known = i < static_cast<int>(graph.first_seen.size());
    joined->first_seen.push_back(known ? graph.first_seen[i] : first_frame);
  }
}

/// Takes the motions of a model in a frame of its own, behind those of the
/// parts before: its nodes begin at `first` and were moved by `shift`.
void AppendMotions(const FrameMotions& own, int first,
                   const Eigen::Vector3d& shift, FrameMotions* all) {
  const int count = static_cast<int>(own.motions.size());
  if (!all->ranges.empty() && all->ranges.back().end == first) {
    all->ranges.back().end += count;
  } else {
    all->ranges.push_back({first, first + count});
  }
  for (NodeMotion motion : own.motions) {
    motion.translation -= shift;
    all->motions.push_back(motion);
  }
  all->seen.insert(all->seen.end(), own.seen.begin(), own.seen.end());
  all->seen.resize(all->motions.size(), false);
}

/// All frames of some models, and whether the surface was tracked in them.
std::map<int, bool> FramesOf(const std::vector<TrackedModel>& models) {
  std::map<int, bool> frames;
  for (const TrackedModel& model : models) {
    for (int i = 0; i < model.history.size(); ++i) {
      frames[model.history.frame(i)] = model.history.tracked(i);
    }
  }
  return frames;
}

}  // namespace

SurfaceModel JoinModels(std::vector<TrackedModel> models) {
  if (models.size() == 1) {
    TrackedModel& only = models.front();
    return {std::move(only.mesh), std::move(only.graph), only.history.All()};
  }
  SurfaceModel joined;
  const std::vector<Eigen::Vector3d> shifts = ShiftsOf(models);
  for (std::size_t i = 0; i < models.size(); ++i) {
    AppendMesh(models[i].mesh, shifts[i], &joined.mesh);
    AppendGraph(models[i], shifts[i], &joined.graph);
    models[i].mesh = {};
  }
  joined.graph.parts.back().end_frame = ModelPart::kNoEnd;
  joined.graph.motions.resize(joined.graph.size());
  std::vector<int> next(models.size(), 0);
  for (const auto& [index, tracked] : FramesOf(models)) {
    FrameMotions all{index, tracked, {}, {}, {}};
    for (std::size_t i = 0; i < models.size(); ++i) {
      const MotionLog& own = models[i].history;
      if (next[i] == own.size() || own.frame(next[i]) != index) continue;
      AppendMotions(own.At(next[i]++), joined.graph.parts[i].node, shifts[i],
                    &all);
    }
    all.SpreadTo(&joined.graph.motions);
    joined.history.Append(std::move(all));
  }
  return joined;
}

}  // namespace splitfusion
