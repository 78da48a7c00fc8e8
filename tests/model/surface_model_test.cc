#include "splitfusion/lib/model/surface_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/model/part_motions.h"
#include "splitfusion/lib/visibility/seen_triangles.h"
#include "support/motion_frames.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// A plate that moves along y by a centimetre a frame, in frames first..last.
SurfaceModel MovingPlate(int first, int last, double width = 0.3) {
  SurfaceModel model;
  model.mesh = PlateMesh(width, 0.3, 0.02, 1);
  model.mesh.normals = ComputeVertexNormals(model.mesh);
  model.graph = CoverWithNodes(model.mesh, 0.05);
  model.graph.first_seen.assign(model.graph.size(), first);
  for (int frame = first; frame <= last; ++frame) {
    model.graph.motions.assign(model.graph.size(), NodeMotion());
    for (NodeMotion& motion : model.graph.motions) {
      motion.translation.y() = 0.01 * frame;
    }
    model.history.Append({frame, true, model.graph.motions,
                          std::vector<char>(model.graph.size(), true)});
  }
  return model;
}

TEST(JoinModels, OneModelStaysAsItIs) {
  const SurfaceModel plate = MovingPlate(2, 4);
  const SurfaceModel joined = JoinModels({plate});
  EXPECT_TRUE(joined.graph.parts.empty());
  EXPECT_EQ(joined.mesh.vertices, plate.mesh.vertices);
  EXPECT_EQ(joined.history.size(), 3);
}

TEST(JoinModels, ShowsEachModelInItsFramesWhereItWas) {
  const SurfaceModel first = MovingPlate(2, 4), second = MovingPlate(5, 9);
  const SurfaceModel joined = JoinModels({first, second});
  const int nodes = first.graph.size();
  const std::size_t vertices = first.mesh.vertices.size();
  ASSERT_EQ(joined.graph.size(), 2 * nodes);
  ASSERT_EQ(joined.graph.parts.size(), 2u);
  EXPECT_EQ(joined.graph.parts[0].end_frame, 5);
  EXPECT_EQ(joined.graph.parts[1].node, nodes);
  EXPECT_EQ(joined.graph.parts[1].first_frame, 5);
  const std::vector<Skinning> skinning =
      SkinningIndex(joined.graph, 6).Skin(joined.mesh.vertices);
  ASSERT_EQ(joined.history.size(), 8);
  for (const FrameMotions& frame : joined.history) {
    const bool late = frame.frame >= 5;
    EXPECT_EQ(frame.Saw(0), !late);
    EXPECT_EQ(frame.Saw(nodes), late);
    const auto triangles =
        SeenTriangles(joined.mesh, skinning, joined.graph, frame.frame);
    ASSERT_EQ(triangles.size(), first.mesh.triangles.size()) << frame.frame;
    DeformationGraph graph = joined.graph;
    frame.SpreadTo(&graph.motions);
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

TEST(JoinModels, ThousandsOfPartsLieNearEnoughForSinglePrecision) {
  const SurfaceModel plate = MovingPlate(2, 3, 0.1);
  SurfaceModel part = plate;
  part.history = Frames(plate.history, 0, 1);
  const std::vector<SurfaceModel> parts(3000, part);
  const SurfaceModel joined = JoinModels(parts);
  ASSERT_EQ(joined.graph.parts.size(), parts.size());
  const FrameMotions first = joined.history.At(0);
  Eigen::AlignedBox3d extent;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int node = joined.graph.parts[i].node;
    const Eigen::Vector3d& g = joined.graph.positions[node];
    extent.extend(g);
    EXPECT_TRUE((g + first.motions[node].translation)
                    .isApprox(plate.graph.positions[0] +
                                  plate.history.At(0).motions[0].translation,
                              1e-12));
    if (i == 0) continue;
    const Eigen::Vector3d& before =
        joined.graph.positions[joined.graph.parts[i - 1].node];
    EXPECT_GT((g - before).norm(), 1);
  }
  EXPECT_LT(extent.sizes().maxCoeff(), 30);  // 1e-6 m.
}

TEST(JoinModels, EdgesStayWithinTheirModel) {
  const SurfaceModel first = MovingPlate(0, 1), second = MovingPlate(2, 3);
  const SurfaceModel joined = JoinModels({first, second});
  const int nodes = first.graph.size();
  for (int i = 0; i < joined.graph.size(); ++i) {
    ASSERT_FALSE(joined.graph.neighbors[i].empty());
    for (const int j : joined.graph.neighbors[i]) {
      EXPECT_EQ(i < nodes, j < nodes);
    }
  }
}

TEST(JoinModels, ShowsARefutedPartBesideTheRestUntilItsEnd) {
  const SurfaceModel part = MovingPlate(2, 4), rest = MovingPlate(2, 9);
  const SurfaceModel joined = JoinModels({part, rest});
  const std::vector<Skinning> skinning =
      SkinningIndex(joined.graph, 6).Skin(joined.mesh.vertices);
  ASSERT_EQ(joined.history.size(), 8);
  for (const FrameMotions& frame : joined.history) {
    EXPECT_EQ(frame.motions.size(),
              part.graph.size() * (frame.frame < 5 ? 2 : 1));
    EXPECT_EQ(
        SeenTriangles(joined.mesh, skinning, joined.graph, frame.frame).size(),
        (frame.frame < 5 ? 2 : 1) * rest.mesh.triangles.size())
        << frame.frame;
  }
}

TEST(WhichWereRefuted, EndedWhileOthersWentOn) {
  DeformationGraph graph;
  EXPECT_TRUE(WhichWereRefuted(graph).empty());
  // A model with two parts that were refuted, and another one after it.
  graph.parts = {{0, 2, 5}, {4, 3, 9}, {7, 2, 12}, {9, 12}};
  EXPECT_EQ(WhichWereRefuted(graph),
            std::vector<char>({true, true, false, false}));
}

TEST(IsInUse, IsFromTheFirstFrameOfAPartUntilItsEnd) {
  DeformationGraph graph;
  graph.positions.resize(10);
  EXPECT_TRUE(graph.IsInUse(9, 7));
  graph.parts = {{0, 2, 9}, {4, 2, 5}, {7, 5}};
  const auto in_use = [&](int frame) {
    std::string text;
    for (int i = 0; i < graph.size(); ++i)
      text += graph.IsInUse(i, frame) ? 'x' : '.';
    return text;
  };
  EXPECT_EQ(in_use(1), "..........");
  EXPECT_EQ(in_use(2), "xxxxxxx...");
  EXPECT_EQ(in_use(5), "xxxx...xxx");
  EXPECT_EQ(in_use(9), ".......xxx");
}

}  // namespace
}  // namespace splitfusion
