#include "splitfusion/lib/deformation/surface_edges.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "splitfusion/lib/geometry/kd_tree.h"

namespace splitfusion {
namespace {

/// Vertex adjacency of a mesh in compressed rows.
struct MeshGraph {
  std::vector<int> begin;  // Per vertex, into `to`.
  std::vector<int> to;
};

MeshGraph BuildMeshGraph(const TriangleMesh& mesh) {
  MeshGraph graph;
  graph.begin.assign(mesh.vertices.size() + 1, 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) graph.begin[t[k] + 1] += 2;
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.to.resize(graph.begin.back());
  std::vector<int> fill(graph.begin.begin(), graph.begin.end() - 1);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      graph.to[fill[t[k]]++] = t[(k + 1) % 3];
      graph.to[fill[t[k]]++] = t[(k + 2) % 3];
    }
  }
  return graph;
}

/// For every vertex the nearest node along the mesh and the path length.
struct Regions {
  std::vector<int> node;
  std::vector<float> distance;
};

/// Vertices waiting for their turn by their distance: in buckets of about an
/// edge's length, first come first served within a bucket. A vertex may get its
/// turn too early and once more; that costs less than a heap.
class DistanceQueue {
 public:
  struct Entry {
    float distance;
    int vertex;
  };

  explicit DistanceQueue(float width) : inverse_width_(1 / width) {}

  void Push(float distance, int vertex) {
    const auto bucket = static_cast<std::size_t>(distance * inverse_width_);
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    buckets_[bucket].push_back({distance, vertex});
  }

  /// The next entry; false if there is none.
  bool Pop(Entry* entry) {
    while (current_ < buckets_.size() && next_ == buckets_[current_].size()) {
      buckets_[current_++] = {};
      next_ = 0;
    }
    if (current_ == buckets_.size()) return false;
    *entry = buckets_[current_][next_++];
    return true;
  }

 private:
  float inverse_width_;
  std::vector<std::vector<Entry>> buckets_;
  std::size_t current_ = 0, next_ = 0;
};

/// Mean length of some edges of a mesh, metres.
float EdgeLength(const TriangleMesh& mesh) {
  const std::size_t step = mesh.triangles.size() / 256 + 1;
  float sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step, ++count) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    sum += (mesh.vertices[t[0]] - mesh.vertices[t[1]]).norm();
  }
  return sum > 0 ? sum / static_cast<float>(count) : 1.0f;
}

Regions GrowRegions(const std::vector<NodeSeed>& seeds,
                    const TriangleMesh& mesh, const MeshGraph& graph) {
  Regions regions;
  regions.node.assign(mesh.vertices.size(), -1);
  regions.distance.assign(mesh.vertices.size(),
                          std::numeric_limits<float>::max());
  DistanceQueue queue(EdgeLength(mesh));
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const auto [vertex, distance] = seeds[i];
    if (vertex < 0 || distance >= regions.distance[vertex]) continue;
    regions.distance[vertex] = distance;
    regions.node[vertex] = static_cast<int>(i);
    queue.Push(distance, vertex);
  }
  DistanceQueue::Entry entry;
  while (queue.Pop(&entry)) {
    const auto [distance, vertex] = entry;
    if (distance > regions.distance[vertex]) continue;
    for (int e = graph.begin[vertex]; e < graph.begin[vertex + 1]; ++e) {
      const int next = graph.to[e];
      if (distance >= regions.distance[next]) continue;
      const float length =
          distance + (mesh.vertices[next] - mesh.vertices[vertex]).norm();
      if (length >= regions.distance[next]) continue;
      regions.distance[next] = length;
      regions.node[next] = regions.node[vertex];
      queue.Push(length, next);
    }
  }
  return regions;
}

using Lengths = std::vector<std::map<int, float>>;  // Per node: other -> path.

void Shorten(int from, int to, float length, Lengths* lengths) {
  const auto [entry, inserted] = (*lengths)[from].emplace(to, length);
  if (!inserted) entry->second = std::min(entry->second, length);
}

Lengths AdjacentRegions(const Regions& regions, const TriangleMesh& mesh,
                        std::size_t node_count) {
  Lengths lengths(node_count);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int v = triangle[k], w = triangle[(k + 1) % 3];
      const int a = regions.node[v], b = regions.node[w];
      if (a == b || a < 0 || b < 0) continue;
      const float length = regions.distance[v] + regions.distance[w] +
                           (mesh.vertices[w] - mesh.vertices[v]).norm();
      Shorten(a, b, length, &lengths);
      Shorten(b, a, length, &lengths);
    }
  }
  return lengths;
}

/// Adds the neighbours of the neighbours.
Lengths WithSecondRing(const Lengths& first) {
  Lengths second = first;
  for (std::size_t a = 0; a < first.size(); ++a) {
    for (const auto& [b, length_ab] : first[a]) {
      for (const auto& [c, length_bc] : first[b]) {
        if (c != static_cast<int>(a)) {
          Shorten(static_cast<int>(a), c, length_ab + length_bc, &second);
        }
      }
    }
  }
  return second;
}

/// Ties nodes with fewer than `minimum` neighbours to the nearest in space.
void TieLooseNodes(const std::vector<Eigen::Vector3d>& nodes, int minimum,
                   std::vector<std::set<int>>* edges) {
  std::vector<Eigen::Vector3f> positions;
  for (const Eigen::Vector3d& g : nodes) positions.push_back(g.cast<float>());
  const KdTree tree(positions);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (static_cast<int>((*edges)[i].size()) >= minimum) continue;
    for (const int j : tree.Nearest(positions[i], minimum + 1)) {
      if (j == static_cast<int>(i)) continue;
      (*edges)[i].insert(j);
      (*edges)[j].insert(static_cast<int>(i));
    }
  }
}

/// Connected parts of the graph, by their smallest node.
std::vector<std::vector<int>> ConnectedParts(
    const std::vector<std::set<int>>& edges, std::vector<int>* part) {
  part->assign(edges.size(), -1);
  std::vector<std::vector<int>> parts;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if ((*part)[i] >= 0) continue;
    const int id = static_cast<int>(parts.size());
    std::vector<int> members = {static_cast<int>(i)};
    (*part)[i] = id;
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (const int j : edges[members[k]]) {
        if ((*part)[j] < 0) (*part)[j] = id, members.push_back(j);
      }
    }
    parts.push_back(std::move(members));
  }
  return parts;
}

/// The shortest edge in space from a part to a node of another one.
std::pair<int, int> ShortestWayOut(const std::vector<Eigen::Vector3d>& nodes,
                                   const std::vector<int>& members,
                                   const std::vector<int>& part) {
  double best = std::numeric_limits<double>::max();
  std::pair<int, int> edge(members.front(), members.front());
  for (const int i : members) {
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const double distance = (nodes[i] - nodes[j]).squaredNorm();
      if (part[j] == part[i] || distance >= best) continue;
      best = distance, edge = {i, static_cast<int>(j)};
    }
  }
  return edge;
}

/// Ties the connected parts of the graph until there is one, as Boruvka's
/// algorithm does: in a round every part but the largest gets its shortest edge
/// to another one. Two small parts that are nearest to each other are then one
/// part, which the next round ties to a third.
void TieParts(const std::vector<Eigen::Vector3d>& nodes,
              std::vector<std::set<int>>* edges) {
  std::vector<int> part;
  auto parts = ConnectedParts(*edges, &part);
  while (parts.size() > 1) {
    const auto largest = std::max_element(
        parts.begin(), parts.end(),
        [](const auto& a, const auto& b) { return a.size() < b.size(); });
    for (auto it = parts.begin(); it != parts.end(); ++it) {
      if (it == largest) continue;
      const auto [from, to] = ShortestWayOut(nodes, *it, part);
      (*edges)[from].insert(to);
      (*edges)[to].insert(from);
    }
    parts = ConnectedParts(*edges, &part);
  }
}

}  // namespace

std::vector<std::vector<int>> ConnectAlongSurface(
    const std::vector<Eigen::Vector3d>& nodes,
    const std::vector<NodeSeed>& seeds, const TriangleMesh& mesh, int count) {
  const Lengths lengths = WithSecondRing(AdjacentRegions(
      GrowRegions(seeds, mesh, BuildMeshGraph(mesh)), mesh, nodes.size()));
  std::vector<std::set<int>> edges(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::vector<std::pair<float, int>> order;
    for (const auto& [j, length] : lengths[i]) order.emplace_back(length, j);
    std::sort(order.begin(), order.end());
    const std::size_t kept = std::min<std::size_t>(count, order.size());
    for (std::size_t k = 0; k < kept; ++k) {
      edges[i].insert(order[k].second);
      edges[order[k].second].insert(static_cast<int>(i));
    }
  }
  constexpr int kMinimumNeighbors = 3;  // Maths: fewer leave a turn free.
  TieLooseNodes(nodes, kMinimumNeighbors, &edges);
  TieParts(nodes, &edges);
  std::vector<std::vector<int>> neighbors;
  neighbors.reserve(edges.size());
  for (const std::set<int>& row : edges) {
    neighbors.emplace_back(row.begin(), row.end());
  }
  return neighbors;
}

}  // namespace splitfusion
