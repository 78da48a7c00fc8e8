#include "splitfusion/lib/model/surface_parts.h"

#include <cmath>
#include <map>
#include <utility>

#include "splitfusion/lib/base/chosen.h"
#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/geometry/triangle_corners.h"

namespace splitfusion {
namespace {

/// The vertices of all triangles that have one of `some`.
std::vector<char> VerticesBeside(const TriangleMesh& mesh,
                                 const std::vector<char>& some) {
  std::vector<char> beside(some.size(), false);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (!some[t[0]] && !some[t[1]] && !some[t[2]]) continue;
    for (int k = 0; k < 3; ++k) beside[t[k]] = true;
  }
  return beside;
}

/// The triangles with a vertex whose nearest node is one of `of_nodes`, and
/// those beside them.
std::vector<Eigen::Vector3i> TrianglesOf(
    const TriangleMesh& mesh, const std::vector<SkinningSupport>& supports,
    const std::vector<char>& of_nodes) {
  std::vector<char> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = of_nodes[supports[i].nearest];
  }
  vertices = VerticesBeside(mesh, vertices);
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    if (vertices[t[0]] || vertices[t[1]] || vertices[t[2]]) {
      triangles.push_back(t);
    }
  }
  return triangles;
}

/// Numbers of the members among themselves; -1: no member.
std::vector<int> Numbers(const std::vector<char>& members) {
  std::vector<int> numbers(members.size(), -1);
  int count = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i] != 0) numbers[i] = count++;
  }
  return numbers;
}

DeformationGraph GraphOf(const DeformationGraph& graph,
                         const std::vector<char>& members) {
  DeformationGraph part;
  part.positions = Chosen(graph.positions, members);
  part.motions = Chosen(graph.motions, members);
  part.neighbors = Chosen(graph.neighbors, members);
  part.first_seen = Chosen(graph.first_seen, members);
  part.node_spacing = graph.node_spacing;
  const std::vector<int> numbers = Numbers(members);
  for (std::vector<int>& edges : part.neighbors) {
    std::vector<int> kept;
    for (const int j : edges) {
      if (numbers[j] >= 0) kept.push_back(numbers[j]);
    }
    edges = std::move(kept);
  }
  return part;
}

/// Some triangles of a mesh, with their vertices alone.
TriangleMesh MeshOf(const TriangleMesh& mesh,
                    const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<char> vertices(mesh.vertices.size(), false);
  for (const Eigen::Vector3i& t : triangles) {
    for (int k = 0; k < 3; ++k) vertices[t[k]] = true;
  }
  TriangleMesh part;
  part.vertices = Chosen(mesh.vertices, vertices);
  part.normals = Chosen(mesh.normals, vertices);
  part.colors = Chosen(mesh.colors, vertices);
  const std::vector<int> numbers = Numbers(vertices);
  for (const Eigen::Vector3i& t : triangles) {
    part.triangles.emplace_back(numbers[t[0]], numbers[t[1]], numbers[t[2]]);
  }
  return part;
}

/// The nodes of `of_nodes` that are the nearest one of a vertex, without those
/// that were seen after `now` or never.
std::vector<int> Carriers(const std::vector<SkinningSupport>& supports,
                          const DeformationGraph& graph,
                          const std::vector<char>& of_nodes, int now) {
  std::vector<char> carries(of_nodes.size(), false);
  for (const SkinningSupport& one : supports) {
    carries[one.nearest] = of_nodes[one.nearest];
  }
  std::vector<int> carriers;
  for (std::size_t i = 0; i < graph.first_seen.size(); ++i) {
    if (carries[i] != 0 && graph.first_seen[i] <= now) {
      carriers.push_back(static_cast<int>(i));
    }
  }
  return carriers;
}

/// Triangles by the nearest one of some nodes.
std::map<int, std::vector<Eigen::Vector3i>> ByCarrier(
    const std::vector<Eigen::Vector3i>& triangles,
    const std::vector<int>& carriers, const TriangleMesh& mesh,
    const DeformationGraph& graph) {
  std::vector<Eigen::Vector3f> places;
  for (const int node : carriers) {
    places.push_back(graph.positions[node].cast<float>());
  }
  const NearestPoint tree(places);
  std::map<int, std::vector<Eigen::Vector3i>> carried;
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3f middle = TriangleCorners(mesh.vertices, t).Middle();
    carried[carriers[tree.Find(middle, -1, nullptr)]].push_back(t);
  }
  return carried;
}

/// Nodes that were seen first at about the same time, and what they carry.
struct Generation {
  std::vector<char> nodes;  // Of every one whether it is.
  std::vector<Eigen::Vector3i> triangles;
};

/// By powers of four of frames since they were seen first. What lies beside a
/// node may be much older: of that it knows nothing.
std::map<int, Generation> Generations(
    const std::map<int, std::vector<Eigen::Vector3i>>& by_carrier,
    const DeformationGraph& graph, int now) {
  std::map<int, Generation> generations;
  for (const auto& [node, triangles] : by_carrier) {
    const int age = now - graph.first_seen[node];
    Generation& one = generations[std::ilogb(age + 1) / 2];
    one.nodes.resize(graph.size(), false);
    one.nodes[node] = true;
    one.triangles.insert(one.triangles.end(), triangles.begin(),
                         triangles.end());
  }
  return generations;
}

}  // namespace

std::vector<SurfacePart> PartsOf(const TriangleMesh& mesh,
                                 const MeshSkinning& skinning,
                                 const DeformationGraph& graph,
                                 const std::vector<char>& of_nodes, int now) {
  std::vector<SurfacePart> parts;
  const std::vector<int> carriers =
      Carriers(skinning.supports(), graph, of_nodes, now);
  if (carriers.empty()) return parts;
  const std::map<int, std::vector<Eigen::Vector3i>> by_carrier = ByCarrier(
      TrianglesOf(mesh, skinning.supports(), of_nodes), carriers, mesh, graph);
  for (auto& [age, generation] : Generations(by_carrier, graph, now)) {
    SurfacePart part;
    part.mesh = MeshOf(mesh, generation.triangles);
    part.graph = GraphOf(graph, generation.nodes);
    part.nodes = std::move(generation.nodes);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace splitfusion
