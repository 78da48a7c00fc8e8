#include "splitfusion/lib/deformation/surface_edges.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "splitfusion/lib/geometry/nearest_point.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

using Neighbors = std::vector<std::vector<int>>;

/// Edges of nodes that begin at the vertices nearest to them.
Neighbors Connect(const std::vector<Eigen::Vector3d>& nodes,
                  const TriangleMesh& mesh, int count) {
  std::vector<NodeSeed> seeds;
  const NearestPoint vertices(mesh.vertices);
  for (const Eigen::Vector3d& g : nodes) {
    NodeSeed seed;
    seed.vertex = vertices.Find(g.cast<float>(), -1, &seed.distance);
    seeds.push_back(seed);
  }
  return ConnectAlongSurface(nodes, seeds, mesh, count);
}

bool Contains(const std::vector<int>& list, int value) {
  return std::binary_search(list.begin(), list.end(), value);
}

/// Nodes that can be reached from node 0.
int Reachable(const Neighbors& neighbors) {
  std::vector<bool> seen(neighbors.size(), false);
  std::vector<int> open = {0};
  seen[0] = true;
  for (std::size_t k = 0; k < open.size(); ++k) {
    for (const int j : neighbors[open[k]]) {
      if (!seen[j]) open.push_back(j);
      seen[j] = true;
    }
  }
  return static_cast<int>(open.size());
}

void ExpectSound(const DeformationGraph& graph) {
  ASSERT_EQ(graph.neighbors.size(), graph.positions.size());
  for (int i = 0; i < graph.size(); ++i) {
    const std::vector<int>& row = graph.neighbors[i];
    EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
    EXPECT_EQ(std::adjacent_find(row.begin(), row.end()), row.end());
    EXPECT_FALSE(Contains(row, i)) << "node " << i << " is tied to itself";
    for (const int j : row) {
      EXPECT_TRUE(Contains(graph.neighbors[j], i)) << i << " -> " << j;
    }
  }
  EXPECT_EQ(Reachable(graph.neighbors), graph.size()) << "loose parts";
}

TEST(SurfaceEdges, TieNearNodesBothWays) {
  const DeformationGraph graph =
      CoverWithNodes(PlateMesh(0.4, 0.3, 0.01, 1), 0.04);
  ExpectSound(graph);
  for (int i = 0; i < graph.size(); ++i) {
    EXPECT_GE(graph.neighbors[i].size(), 3u);
    for (const int j : graph.neighbors[i]) {
      EXPECT_LT((graph.positions[i] - graph.positions[j]).norm(), 0.14);
    }
  }
}

TEST(SurfaceEdges, TheNearestNodeOfAnEvenCoverIsANeighbour) {
  const DeformationGraph graph =
      CoverWithNodes(PlateMesh(0.4, 0.3, 0.01, 1), 0.04);
  for (int i = 0; i < graph.size(); ++i) {
    int nearest = -1;
    double best = 1e9;
    for (int j = 0; j < graph.size(); ++j) {
      const double d = (graph.positions[i] - graph.positions[j]).norm();
      if (j != i && d < best) best = d, nearest = j;
    }
    EXPECT_TRUE(Contains(graph.neighbors[i], nearest));
  }
}

TEST(SurfaceEdges, FollowTheSurfaceNotTheGap) {
  constexpr double kLength = 0.4, kGap = 0.03;
  const DeformationGraph graph =
      CoverWithNodes(HairpinMesh(kLength, 0.2, kGap, 0.005), 0.025);
  ExpectSound(graph);
  for (int i = 0; i < graph.size(); ++i) {
    if (graph.positions[i].x() > kLength - 0.06) continue;
    for (const int j : graph.neighbors[i]) {
      EXPECT_LT(std::abs(graph.positions[i].z() - graph.positions[j].z()),
                kGap / 2)
          << "an edge jumps from plate to plate at x = "
          << graph.positions[i].x();
    }
  }
}

TEST(SurfaceEdges, LoosePartsAreTiedByFewEdges) {
  TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  AppendMesh(PlateMesh(0.3, 0.2, 0.01, 1.2), &mesh);
  AppendMesh(PlateMesh(0.02, 0.02, 0.01, 1.5), &mesh);  // One node.
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  ExpectSound(graph);
  int between_plates = 0;
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) {
      between_plates +=
          graph.positions[i].z() < 1.1 && graph.positions[j].z() > 1.1;
    }
  }
  EXPECT_GE(between_plates, 1);
  EXPECT_LE(between_plates, 3);
}

TEST(SurfaceEdges, LoosePartsNearEachOtherAreTiedToTheBodyToo) {
  // Two stray pieces are nearest to each other and far from the body; two more
  // pairs of them are farther still.
  TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  for (const double z : {1.5, 1.55, 2.5, 2.55, 4.0, 4.05}) {
    AppendMesh(PlateMesh(0.12, 0.08, 0.01, z), &mesh);
  }
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  ExpectSound(graph);
}

TEST(SurfaceEdges, FewNodesAreTiedToAllOthers) {
  const TriangleMesh mesh = PlateMesh(0.1, 0.1, 0.01, 1);
  const std::vector<Eigen::Vector3d> nodes = {
      {0, 0, 1}, {0.1, 0, 1}, {0.1, 0.1, 1}};
  const Neighbors neighbors = Connect(nodes, mesh, 8);
  EXPECT_EQ(neighbors, (Neighbors{{1, 2}, {0, 2}, {0, 1}}));
  EXPECT_EQ(Connect({nodes[0]}, mesh, 8), Neighbors(1));
}

TEST(SurfaceEdges, TwoNodesAtOneVertexAreBothTied) {
  const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.01, 1);
  const std::vector<Eigen::Vector3d> nodes = {
      {0, 0, 1}, {0.001, 0, 1}, {0.1, 0, 1}, {0.2, 0.1, 1}, {0.1, 0.1, 1}};
  for (const std::vector<int>& row : Connect(nodes, mesh, 8)) {
    EXPECT_GE(row.size(), 3u);
  }
}

TEST(SurfaceEdges, ANodeWithoutASeedIsTiedToThoseNearInSpace) {
  const TriangleMesh mesh = PlateMesh(0.2, 0.1, 0.01, 1);
  const std::vector<Eigen::Vector3d> nodes = {
      {0, 0, 1}, {0.05, 0, 1}, {0.1, 0, 1}, {0.15, 0, 1}, {0.2, 0, 1.2}};
  std::vector<NodeSeed> seeds(5);
  for (int i = 0; i < 4; ++i) seeds[i] = {5 * i, 0};
  EXPECT_EQ(ConnectAlongSurface(nodes, seeds, mesh, 8)[4],
            (std::vector<int>{1, 2, 3}));
}

TEST(SurfaceEdges, CountLimitsTheEdgesOfANode) {
  const TriangleMesh mesh = PlateMesh(0.4, 0.3, 0.01, 1);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const auto mean_edges = [&](int count) {
    std::size_t edges = 0;
    for (const auto& row : Connect(graph.positions, mesh, count)) {
      edges += row.size();
    }
    return static_cast<double>(edges) / graph.size();
  };
  // Both directions of an edge are kept, so that a few nodes have more.
  EXPECT_LT(mean_edges(4), 6);
  EXPECT_GT(mean_edges(8), 7);
  EXPECT_LT(mean_edges(8), 12);
}

}  // namespace
}  // namespace splitfusion
