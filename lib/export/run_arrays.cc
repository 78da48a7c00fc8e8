#include "splitfusion/lib/export/run_arrays.h"

#include <algorithm>
#include <cstdint>

#include "splitfusion/lib/export/npz_file.h"

namespace splitfusion {
namespace {

using Integers = std::vector<std::int32_t>;
using Floats = std::vector<float>;

/// Appends a matrix row by row.
template <typename Matrix, typename T>
void AppendRows(const Matrix& matrix, std::vector<T>* values) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      values->push_back(static_cast<T>(matrix(row, column)));
    }
  }
}

/// Adds an array of rows of three.
template <typename T, typename Rows>
void AddRows(const std::string& name, const Rows& rows, NpzArrays* arrays) {
  std::vector<T> values;
  for (const auto& row : rows) {
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<T>(row[k]));
  }
  arrays->Add(name, {rows.size(), 3}, values);
}

void AddFrames(const ExportScene& scene, NpzArrays* arrays) {
  Integers indices;
  std::vector<double> timestamps, poses;
  for (const ExportFrame& frame : scene.frames) {
    indices.push_back(frame.index);
    timestamps.push_back(frame.timestamp);
    AppendRows(frame.world_from_camera.matrix(), &poses);
  }
  const std::size_t count = scene.frames.size();
  arrays->Add("frames", {count}, indices);
  arrays->Add("timestamps", {count}, timestamps);
  arrays->Add("world_from_camera", {count, 4, 4}, poses);
  if (!scene.camera) return;
  const PinholeCamera& c = *scene.camera;
  arrays->Add(
      "intrinsics", {6},
      std::vector<double>{c.fx, c.fy, c.cx, c.cy, static_cast<double>(c.width),
                          static_cast<double>(c.height)});
}

void AddMeshArrays(const ExportSurface& surface, NpzArrays* arrays) {
  const std::string below = surface.name + "/";
  const TriangleMesh& mesh = surface.mesh;
  AddRows<float>(below + "vertices", mesh.vertices, arrays);
  if (!mesh.normals.empty()) {
    AddRows<float>(below + "normals", mesh.normals, arrays);
  }
  if (!mesh.colors.empty()) {
    AddRows<std::uint8_t>(below + "colors", mesh.colors, arrays);
  }
  AddRows<std::int32_t>(below + "triangles", mesh.triangles, arrays);
  arrays->Add(below + "source", {surface.source.size()},
              Integers(surface.source.begin(), surface.source.end()));
}

void AddGraphArrays(const ExportSurface& surface, NpzArrays* arrays) {
  const std::string below = surface.name + "/";
  AddRows<double>(below + "positions", surface.graph.positions, arrays);
  Integers edges, nodes;
  const std::vector<std::vector<int>>& neighbors = surface.graph.neighbors;
  for (std::size_t i = 0; i < neighbors.size(); ++i) {
    for (const int j : neighbors[i]) {
      edges.push_back(static_cast<std::int32_t>(i));
      edges.push_back(j);
    }
  }
  arrays->Add(below + "edges", {edges.size() / 2, 2}, edges);
  int most = 0;
  for (const Skinning& one : surface.skinning) most = std::max(most, one.count);
  Floats weights;
  for (const Skinning& one : surface.skinning) {
    nodes.insert(nodes.end(), one.nodes.begin(), one.nodes.begin() + most);
    weights.insert(weights.end(), one.weights.begin(),
                   one.weights.begin() + most);  // 0 behind the last.
  }
  const auto columns = static_cast<std::size_t>(most);
  arrays->Add(below + "nodes", {surface.skinning.size(), columns}, nodes);
  arrays->Add(below + "weights", {surface.skinning.size(), columns}, weights);
}

/// Mean of the vertices in a frame.
Eigen::Vector3d CenterAt(const ExportSurface& surface,
                         const ExportMoment& moment) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : surface.VerticesAt(moment, surface.skinning)) {
    sum += p.cast<double>();
  }
  return sum / static_cast<double>(surface.mesh.vertices.size());
}

void AddMotionArrays(const ExportSurface& surface, NpzArrays* arrays) {
  Integers frames;
  std::vector<std::uint8_t> tracked;
  Floats rotations, translations;
  std::vector<Eigen::Vector3d> centers;
  for (const ExportMoment& moment : surface.moments) {
    frames.push_back(moment.frame);
    tracked.push_back(moment.tracked);
    centers.push_back(CenterAt(surface, moment));
    for (const NodeMotion& motion : moment.motions) {
      AppendRows(motion.rotation, &rotations);
      AppendRows(motion.translation, &translations);
    }
  }
  const std::string below = surface.name + "/";
  const std::size_t count = frames.size();
  const auto nodes = static_cast<std::size_t>(surface.graph.size());
  arrays->Add(below + "frames", {count}, frames);
  arrays->Add(below + "tracked", {count}, tracked);
  arrays->Add(below + "rotations", {count, nodes, 3, 3}, rotations);
  arrays->Add(below + "translations", {count, nodes, 3}, translations);
  AddRows<float>(below + "centers", centers, arrays);
}

}  // namespace

void WriteRunArrays(const std::string& path, const ExportScene& scene) {
  WriteNpz(path, [&](NpzArrays* arrays) {
    AddFrames(scene, arrays);
    for (const ExportSurface& surface : scene.surfaces) {
      AddMeshArrays(surface, arrays);
      AddGraphArrays(surface, arrays);
      AddMotionArrays(surface, arrays);
    }
  });
}

}  // namespace splitfusion
