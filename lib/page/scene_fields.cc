#include "splitfusion/lib/page/scene_fields.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/render/depth_residuals.h"

namespace splitfusion {
namespace {

std::int32_t InSteps(double metres) {
  return static_cast<std::int32_t>(std::lround(metres / NodeField::kUnit));
}

/// A further frame in which no node has a value yet; returns their row.
std::int32_t* AddFrame(int frame, std::size_t nodes, NodeField* field) {
  field->frames.push_back(frame);
  field->values.resize(field->values.size() + nodes, -1);
  return &field->values[field->values.size() - nodes];
}

NodeField Residuals(const RunPaths& paths, const RecordedSurface& surface) {
  NodeField field{"residual", "distance from the depth", 0.05, false, {}, {}};
  const std::string path = paths.Residuals(surface.id, surface.label);
  const auto nodes = surface.graph.positions.size();
  std::int32_t* row = nullptr;
  for (const DepthResidual& one : ReadResiduals(path)) {
    if (one.node < 0 || one.node >= surface.graph.size()) {
      throw InputError(path + ": node " + std::to_string(one.node) +
                       ": expected a node of graph.json");
    }
    if (field.frames.empty() || field.frames.back() != one.frame) {
      row = AddFrame(one.frame, nodes, &field);
    }
    row[one.node] = InSteps(one.depth);
  }
  return field;
}

/// Nodes have the deviation of the vertex that is nearest to where they are
/// carried, if it is nearer than other nodes.
void AddDeviations(const TriangleMesh& mesh, const std::vector<double>& sigma,
                   const RecordedSurface& surface, const FrameMotions& motions,
                   NodeField* field) {
  const NearestPoint nearest(mesh.vertices);
  const DeformationGraph& graph = surface.graph;
  std::int32_t* row = AddFrame(motions.frame, graph.positions.size(), field);
  for (int n = 0; n < graph.size(); ++n) {
    if (!graph.IsInUse(n, motions.frame)) continue;
    const Eigen::Vector3d place =
        ApplyNode(graph.positions[n], motions.Of(n), graph.positions[n]);
    float distance = 0;
    const int vertex = nearest.Find(place.cast<float>(), -1, &distance);
    if (distance < graph.node_spacing) row[n] = InSteps(sigma[vertex]);
  }
}

NodeField Uncertainty(const RunPaths& paths, const RecordedSurface& surface) {
  NodeField field{"sigma", "uncertainty", 0.02, true, {}, {}};
  for (int i = 0; i < surface.motions.size(); ++i) {
    const std::string path =
        paths.Uncertainty(surface.motions.frame(i), surface.id);
    if (!std::filesystem::exists(path)) continue;
    PlyProperties extra;
    const TriangleMesh mesh = ReadPly(path, &extra);
    const std::vector<double>& sigma = extra["sigma"];
    if (mesh.vertices.empty() || sigma.size() != mesh.vertices.size()) {
      throw InputError(path + ": expected vertices with a property 'sigma'");
    }
    AddDeviations(mesh, sigma, surface, surface.motions.At(i), &field);
  }
  return field;
}

}  // namespace

std::vector<NodeField> FieldsOf(const RunPaths& paths,
                                const RecordedSurface& surface) {
  std::vector<NodeField> fields = {Residuals(paths, surface),
                                   Uncertainty(paths, surface)};
  fields.erase(std::remove_if(
                   fields.begin(), fields.end(),
                   [](const NodeField& field) { return field.frames.empty(); }),
               fields.end());
  return fields;
}

}  // namespace splitfusion
