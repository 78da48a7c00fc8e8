#include "splitfusion/lib/model/surface_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "splitfusion/lib/visibility/seen_triangles.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

constexpr int kNow = 100;
constexpr int kNeighbors = 6;

/// A plate 0.9 m long, rolled up; of which the nodes beyond x = 0.7 m are
/// refuted.
class PartsOfPlate : public testing::Test {
 protected:
  PartsOfPlate() {
    mesh_ = PlateMesh(0.9, 0.3, 0.02, 1);
    mesh_.normals = ComputeVertexNormals(mesh_);
    graph_ = CoverWithNodes(mesh_, 0.05);
    graph_.first_seen.assign(graph_.size(), 2);
    MoveNodes([](const Eigen::Vector3d& p) { return Bend(p, 1, 1); }, &graph_);
    for (const Eigen::Vector3d& g : graph_.positions) {
      refuted_.push_back(g.x() > 0.7);
    }
  }

  std::vector<SurfacePart> Parts() const {
    const SkinningIndex index(graph_, kNeighbors);
    return PartsOf(mesh_, MeshSkinning(index, mesh_.vertices), graph_, refuted_,
                   kNow);
  }

  TriangleMesh mesh_;
  DeformationGraph graph_;
  std::vector<char> refuted_;
};

TEST_F(PartsOfPlate, AreCarriedAsTheyWere) {
  const std::vector<SurfacePart> parts = Parts();
  ASSERT_EQ(parts.size(), 1u);
  const SurfacePart& part = parts[0];
  ASSERT_GT(part.mesh.triangles.size(), 10u);
  EXPECT_LT(part.mesh.triangles.size(), mesh_.triangles.size() / 2);
  EXPECT_EQ(part.mesh.normals.size(), part.mesh.vertices.size());
  EXPECT_LT(part.graph.size(), graph_.size());
  EXPECT_EQ(std::count(part.nodes.begin(), part.nodes.end(), true),
            part.graph.size());
  const WarpField warp(part.graph), whole(graph_);
  const SkinningIndex part_index(part.graph, kNeighbors);
  const SkinningIndex index(graph_, kNeighbors);
  for (const Eigen::Vector3f& v : part.mesh.vertices) {
    EXPECT_LT((warp.WarpPoint(part_index.Skin(v), v) -
               whole.WarpPoint(index.Skin(v), v))
                  .norm(),
              0.003f);
  }
}

TEST_F(PartsOfPlate, HaveTheirOwnNodesAlone) {
  EXPECT_EQ(Parts()[0].nodes, refuted_);
  std::fill(refuted_.begin(), refuted_.end(), false);
  refuted_[graph_.size() / 2] = true;
  const std::vector<SurfacePart> parts = Parts();
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].graph.size(), 1);
  EXPECT_GT(parts[0].mesh.triangles.size(), 4u);
}

TEST_F(PartsOfPlate, BeginWithTheirFirstSight) {
  for (int i = 0; i < graph_.size(); ++i) {
    if (graph_.positions[i].x() > 0.8) graph_.first_seen[i] = 90;
  }
  const std::vector<SurfacePart> parts = Parts();
  ASSERT_EQ(parts.size(), 2u);  // 11 and 99 frames, now among them.
  EXPECT_EQ(parts[0].graph.first_seen.front(), 90);
  EXPECT_EQ(parts[1].graph.first_seen.front(), 2);
  EXPECT_LT(parts[0].graph.size(), graph_.size() / 2);
  const std::size_t both =
      parts[0].mesh.triangles.size() + parts[1].mesh.triangles.size();
  graph_.first_seen.assign(graph_.size(), 2);
  const std::vector<SurfacePart> at_once = Parts();
  ASSERT_EQ(at_once.size(), 1u);
  EXPECT_EQ(at_once[0].mesh.triangles.size(), both);
}

TEST_F(PartsOfPlate, AreNoneOfNoNodesAndOfWhatWasNotSeen) {
  graph_.first_seen.assign(graph_.size(), kNow + 1);
  EXPECT_TRUE(Parts().empty());
  graph_.first_seen.clear();
  EXPECT_TRUE(Parts().empty());
  graph_.first_seen.assign(graph_.size(), 2);
  std::fill(refuted_.begin(), refuted_.end(), false);
  EXPECT_TRUE(Parts().empty());
}

}  // namespace
}  // namespace splitfusion
