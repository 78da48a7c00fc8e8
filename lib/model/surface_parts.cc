#include "splitfusion/lib/model/surface_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "splitfusion/lib/base/chosen.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

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

/// Marks the nodes by which `center` reaches some others in as few edges as in
/// the whole graph, by marked ones where it can.
void MarkWays(const DeformationGraph& graph, int center,
              const std::set<int>& others, std::vector<char>* marked) {
  std::map<int, int> before = {{center, center}};
  std::size_t missing = others.size() - others.count(center);
  for (std::vector<int> ring = {center}; missing > 0 && !ring.empty();) {
    std::stable_partition(ring.begin(), ring.end(),
                          [&](int i) { return (*marked)[i] != 0; });
    std::vector<int> next;
    for (const int i : ring) {
      for (const int j : graph.neighbors[i]) {
        if (!before.emplace(j, i).second) continue;
        next.push_back(j);
        missing -= others.count(j);
      }
    }
    ring = std::move(next);
  }
  for (int node : others) {
    for (; node != center; node = before.at(node)) (*marked)[node] = true;
  }
}

/// The nodes by which a SkinningIndex of theirs gives the same skinning of some
/// vertices: those that it looks at, and those by which it comes upon them.
std::vector<char> NodesFor(const std::vector<char>& vertices,
                           const TriangleMesh& mesh,
                           const std::vector<SkinningSupport>& supports,
                           const SkinningIndex& index,
                           const DeformationGraph& graph) {
  std::map<int, std::set<int>> looked_at;  // By nearest node.
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] == 0) continue;
    const std::vector<int> nodes =
        index.NodesLookedAt(mesh.vertices[i], supports[i].nearest);
    looked_at[supports[i].nearest].insert(nodes.begin(), nodes.end());
  }
  std::vector<char> marked(graph.size(), false);
  for (const auto& [nearest, nodes] : looked_at) {
    marked[nearest] = true;
    for (const int node : nodes) marked[node] = true;
  }
  for (const auto& [nearest, nodes] : looked_at) {
    MarkWays(graph, nearest, nodes, &marked);
  }
  return marked;
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
                    const std::vector<Eigen::Vector3i>& triangles,
                    const std::vector<char>& vertices) {
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

/// Triangles that were seen first at about the same time.
struct TrianglesOfAge {
  std::vector<Eigen::Vector3i> triangles;
  int first_frame = std::numeric_limits<int>::max();
};

/// Triangles by the power of two of frames since they were seen first.
std::map<int, TrianglesOfAge> ByAge(
    const std::vector<Eigen::Vector3i>& triangles, const TriangleMesh& mesh,
    const std::vector<Skinning>& skinning, const DeformationGraph& graph,
    int now) {
  std::map<int, TrianglesOfAge> by_age;
  for (const Eigen::Vector3i& t : triangles) {
    int first = 0;
    for (int k = 0; k < 3; ++k) {
      first = std::max(first,
                       FirstSight(mesh.vertices[t[k]], skinning[t[k]], graph));
    }
    if (first > now) continue;
    TrianglesOfAge& of_age = by_age[std::ilogb(now - first + 1)];
    of_age.triangles.push_back(t);
    of_age.first_frame = std::min(of_age.first_frame, first);
  }
  return by_age;
}

}  // namespace

std::vector<SurfacePart> PartsOf(const TriangleMesh& mesh,
                                 const MeshSkinning& skinning,
                                 const SkinningIndex& index,
                                 const DeformationGraph& graph,
                                 const std::vector<char>& of_nodes, int now) {
  std::vector<SurfacePart> parts;
  const std::vector<SkinningSupport>& supports = skinning.supports();
  for (const auto& [age, of_age] :
       ByAge(TrianglesOf(mesh, supports, of_nodes), mesh, skinning.skinning(),
             graph, now)) {
    std::vector<char> vertices(mesh.vertices.size(), false);
    for (const Eigen::Vector3i& t : of_age.triangles) {
      for (int k = 0; k < 3; ++k) vertices[t[k]] = true;
    }
    SurfacePart part;
    part.mesh = MeshOf(mesh, of_age.triangles, vertices);
    part.nodes = NodesFor(vertices, mesh, supports, index, graph);
    part.graph = GraphOf(graph, part.nodes);
    part.first_frame = of_age.first_frame;
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace splitfusion
