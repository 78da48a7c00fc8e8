#include "splitfusion/lib/deformation/mesh_skinning.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "splitfusion/lib/deformation/graph_growth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

TriangleMesh Plate(double width) { return PlateMesh(width, 0.3, 0.01, 1); }

/// Every vertex has the skinning that the index gives.
void ExpectSkinnedBy(const SkinningIndex& index, const TriangleMesh& mesh,
                     const MeshSkinning& skinning) {
  const MeshSkinning expected(index, mesh.vertices);
  ASSERT_EQ(skinning.skinning().size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Skinning& a = skinning.skinning()[i];
    const Skinning& b = expected.skinning()[i];
    EXPECT_EQ(a.nodes, b.nodes) << i;
    EXPECT_EQ(a.weights, b.weights) << i;
    EXPECT_EQ(skinning.supports()[i].nearest, expected.supports()[i].nearest);
    EXPECT_EQ(skinning.supports()[i].distance, expected.supports()[i].distance);
  }
}

/// Vertices whose skinning a change of the graph keeps.
int CountKept(const SkinningChange& change, const MeshSkinning& skinning) {
  int kept = 0;
  for (const SkinningSupport& support : skinning.supports()) {
    kept += change.Keeps(support);
  }
  return kept;
}

TEST(MeshSkinning, FollowsAGrowingGraph) {
  const TriangleMesh mesh = Plate(0.9);
  DeformationGraph graph = CoverWithNodes(Plate(0.6), 0.04);
  const SkinningIndex before(graph, 6);
  MeshSkinning skinning(before, mesh.vertices);
  GraphRecord record{0.04, std::vector<char>(graph.size(), true)};
  const NodeChange nodes = UpdateGraph(mesh, GraphOptions(), before, skinning,
                                       &graph, &record, nullptr);
  ASSERT_GT(nodes.added, 0);
  const SkinningIndex after(graph, 6);
  const SkinningChange change(before, after, graph, nodes);
  const int kept = CountKept(change, skinning);
  EXPECT_GT(kept, 0.3 * mesh.vertices.size());
  EXPECT_LT(kept, 0.7 * mesh.vertices.size());
  skinning.FollowGraph(after, mesh.vertices, change);
  ExpectSkinnedBy(after, mesh, skinning);
}

TEST(MeshSkinning, FollowsAGraphThatForgetsNodesAndGrows) {
  // The mesh ends where the old one was in the middle, and reaches beyond it.
  TriangleMesh mesh = Plate(0.6);
  for (Eigen::Vector3f& v : mesh.vertices) v.x() += 0.3f;
  DeformationGraph graph = CoverWithNodes(Plate(0.6), 0.04);
  const SkinningIndex before(graph, 6);
  MeshSkinning skinning(before, mesh.vertices);
  GraphRecord record{0.04, std::vector<char>(graph.size(), true)};
  const NodeChange nodes = UpdateGraph(mesh, GraphOptions(), before, skinning,
                                       &graph, &record, nullptr);
  ASSERT_GT(nodes.forgotten(), 20);
  ASSERT_GT(nodes.added, 20);
  const SkinningIndex after(graph, 6);
  const SkinningChange change(before, after, graph, nodes);
  const int kept = CountKept(change, skinning);
  EXPECT_GT(kept, 0.1 * mesh.vertices.size());
  skinning.FollowGraph(after, mesh.vertices, change);
  ExpectSkinnedBy(after, mesh, skinning);
}

TEST(MeshSkinning, FollowsEdgesThatComeAndGo) {
  const TriangleMesh mesh = Plate(0.6);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const SkinningIndex before(graph, 6);
  MeshSkinning skinning(before, mesh.vertices);
  graph.neighbors[7].resize(2);
  graph.neighbors[40] = {0, 1, 2};
  const SkinningIndex after(graph, 6);
  skinning.FollowGraph(after, mesh.vertices,
                       {before, after, graph, NodeChange::None(graph.size())});
  ExpectSkinnedBy(after, mesh, skinning);
}

TEST(MeshSkinning, FollowsAMeshOfWhichAPartIsNew) {
  const TriangleMesh mesh = Plate(0.6);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const SkinningIndex index(graph, 6);
  MeshSkinning skinning(index, mesh.vertices);
  TriangleMesh changed;
  std::vector<int> kept_from;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) {
    const bool is_new = i % 3 == 0;
    kept_from.push_back(is_new ? -1 : static_cast<int>(i));
    changed.vertices.push_back(mesh.vertices[i] +
                               Eigen::Vector3f(0, 0, is_new ? 0.01f : 0.0f));
  }
  skinning.FollowMesh(index, changed.vertices, kept_from);
  ExpectSkinnedBy(index, changed, skinning);
}

TEST(SkinningChange, OfAFewNodesKeepsNothing) {
  // All of them carry every point.
  const TriangleMesh mesh = PlateMesh(0.05, 0.05, 0.01, 1);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  ASSERT_LT(graph.size(), 6);
  const SkinningIndex index(graph, 6);
  const MeshSkinning skinning(index, mesh.vertices);
  const SkinningChange change(index, index, graph,
                              NodeChange::None(graph.size()));
  for (const SkinningSupport& support : skinning.supports()) {
    EXPECT_FALSE(change.Keeps(support));
  }
}

}  // namespace
}  // namespace splitfusion
