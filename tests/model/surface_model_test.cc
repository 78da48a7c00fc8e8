#include "splitfusion/lib/model/surface_model.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/visibility/seen_triangles.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A plate that moves along y by a centimetre a frame, in frames first..last.
SurfaceModel MovingPlate(int first, int last) {
  SurfaceModel model;
  model.mesh = PlateMesh(0.3, 0.3, 0.02, 1);
  model.mesh.normals = ComputeVertexNormals(model.mesh);
  model.graph = CoverWithNodes(model.mesh, 0.05);
  model.graph.first_seen.assign(model.graph.size(), first);
  for (int frame = first; frame <= last; ++frame) {
    model.graph.motions.assign(model.graph.size(), NodeMotion());
    for (NodeMotion& motion : model.graph.motions) {
      motion.translation.y() = 0.01 * frame;
    }
    model.history.frames.push_back({frame, true, model.graph.motions});
  }
  return model;
}

TEST(JoinModels, OneModelStaysAsItIs) {
  const SurfaceModel plate = MovingPlate(2, 4);
  const SurfaceModel joined = JoinModels({&plate});
  EXPECT_TRUE(joined.graph.models.empty());
  EXPECT_EQ(joined.mesh.vertices, plate.mesh.vertices);
  EXPECT_EQ(joined.history.frames.size(), 3u);
}

TEST(JoinModels, ShowsEachModelInItsFramesWhereItWas) {
  const SurfaceModel first = MovingPlate(2, 4), second = MovingPlate(5, 9);
  const SurfaceModel joined = JoinModels({&first, &second});
  const int nodes = first.graph.size();
  const std::size_t vertices = first.mesh.vertices.size();
  ASSERT_EQ(joined.graph.size(), 2 * nodes);
  ASSERT_EQ(joined.graph.models.size(), 2u);
  EXPECT_EQ(joined.graph.models[1].node, nodes);
  EXPECT_EQ(joined.graph.models[1].frame, 5);
  const std::vector<Skinning> skinning =
      SkinningIndex(joined.graph, 6).Skin(joined.mesh.vertices);
  ASSERT_EQ(joined.history.frames.size(), 8u);
  for (const FrameMotions& frame : joined.history.frames) {
    const bool late = frame.frame >= 5;
    const auto triangles =
        SeenTriangles(joined.mesh, skinning, joined.graph, frame.frame);
    ASSERT_EQ(triangles.size(), first.mesh.triangles.size()) << frame.frame;
    DeformationGraph graph = joined.graph;
    graph.motions = frame.motions;
    const WarpField warp(graph);
    for (const Eigen::Vector3i& t : triangles) {
      EXPECT_EQ(t[0] >= static_cast<int>(vertices), late);
      const Eigen::Vector3f where =
          warp.WarpPoint(skinning[t[0]], joined.mesh.vertices[t[0]]);
      const Eigen::Vector3f expected =
          first.mesh.vertices[t[0] - (late ? vertices : 0)] +
          Eigen::Vector3f(0, 0.01f * frame.frame, 0);
      EXPECT_LT((where - expected).norm(), 1e-5f);
    }
  }
}

TEST(JoinModels, EdgesStayWithinTheirModel) {
  const SurfaceModel first = MovingPlate(0, 1), second = MovingPlate(2, 3);
  const SurfaceModel joined = JoinModels({&first, &second});
  const int nodes = first.graph.size();
  for (int i = 0; i < joined.graph.size(); ++i) {
    ASSERT_FALSE(joined.graph.neighbors[i].empty());
    for (const int j : joined.graph.neighbors[i]) {
      EXPECT_EQ(i < nodes, j < nodes);
    }
  }
}

TEST(NodesInUse, AreThoseOfTheLatestModelThatHasBegun) {
  DeformationGraph graph;
  graph.positions.resize(10);
  EXPECT_EQ(graph.NodesInUse(7).end, 10);
  graph.models = {{0, 2}, {4, 5}, {7, 9}};
  for (const auto& [frame, begin, end] :
       {std::array<int, 3>{0, 0, 4}, {4, 0, 4}, {5, 4, 7}, {8, 4, 7},
        {9, 7, 10}, {50, 7, 10}}) {
    EXPECT_EQ(graph.NodesInUse(frame).begin, begin) << frame;
    EXPECT_EQ(graph.NodesInUse(frame).end, end) << frame;
  }
}

}  // namespace
}  // namespace splitfusion
