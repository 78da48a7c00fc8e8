#include "splitfusion/lib/model/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/geometry/stretched_area.h"
#include "splitfusion/lib/render/model_rendering.h"
#include "splitfusion/lib/report/surface_output.h"
#include "support/expect_input_error.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// A wall at 1.5 m; `area` of it stands 0.5 m nearer and is surface 1.
LiveView ViewWithBox(const cv::Rect& area) {
  cv::Mat_<float> depth = WallDepth(SmallCamera(), 1.5);
  depth(area).setTo(1.0f);
  LiveView live = MakeLiveView(SmallCamera(), depth,
                               PlainColor(SmallCamera(), {10, 200, 30}));
  live.labels(area).setTo(1);
  return live;
}

const cv::Rect kHalf(50, 40, 30, 40), kWhole(50, 40, 60, 40);

Surface MakeBox(SurfaceKind kind) {
  return Surface(1, "teddy bear", kind, 4, SurfaceOptions());
}

TEST(Surface, TheRigidBackgroundHasOneNodeAndIsRayCast) {
  Surface background(0, "background", SurfaceKind::kRigid, 0, {});
  ASSERT_TRUE(background.Initialize(ViewWithBox(kHalf)));
  EXPECT_TRUE(background.is_ray_cast());
  EXPECT_TRUE(background.graph().rigid());
  background.FinishMesh();
  for (const Eigen::Vector3f& v : background.mesh().vertices) {
    EXPECT_NEAR(v.z(), 1.5, 0.01) << "the box is another surface";
  }
}

TEST(Surface, ForgetsWhatIsOfAnotherOne) {
  LiveView live = ViewWithBox(kHalf);
  live.labels.setTo(0);  // Nobody knows yet that the box is one.
  Surface background(0, "background", SurfaceKind::kRigid, 0, {});
  ASSERT_TRUE(background.Initialize(live));
  for (int i = 0; i < 10; ++i) background.Fuse(live);
  live = ViewWithBox(kHalf);
  background.ForgetOther(live, 1);
  background.FinishMesh();
  int wall = 0;
  for (const Eigen::Vector3f& v : background.mesh().vertices) {
    wall += v.z() > 1.4;
    const auto pixel = live.camera.PixelOf(v);
    EXPECT_FALSE(v.z() < 1.1 && IsCertain(live, 1, pixel->y(), pixel->x()));
  }
  EXPECT_GT(wall, 1000);
}

TEST(Surface, NothingSeenIsNoSurface) {
  LiveView live = ViewWithBox(kHalf);
  live.labels.setTo(0);
  EXPECT_FALSE(MakeBox(SurfaceKind::kNonRigid).Initialize(live));
  live.depth.setTo(0);
  Surface background(0, "background", SurfaceKind::kRigid, 0, {});
  EXPECT_FALSE(background.Initialize(live));
}

TEST(Surface, AnObjectIsMeshedAndCoveredWithNodes) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  EXPECT_FALSE(box.is_ray_cast());
  ASSERT_GT(box.mesh().vertices.size(), 300u);
  for (const Eigen::Vector3f& v : box.mesh().vertices) {
    EXPECT_NEAR(v.z(), 1.0, 0.01);
  }
  EXPECT_GT(box.graph().size(), 20);
  EXPECT_EQ(box.graph().node_spacing, NodeSpacing(box.graph_options(), 1.0));
  EXPECT_EQ(box.mesh_skinning().size(), box.mesh().vertices.size());
  Surface rigid = MakeBox(SurfaceKind::kRigid);
  ASSERT_TRUE(rigid.Initialize(ViewWithBox(kHalf)));
  EXPECT_TRUE(rigid.graph().rigid());
}

TEST(Surface, GrowsOverWhatComesIntoView) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  box.RecordMotions(4, true);
  const int nodes = box.graph().size();
  const std::size_t vertices = box.mesh().vertices.size();
  for (int frame = 5; frame < 9; ++frame) {
    box.Fuse(ViewWithBox(kWhole));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  EXPECT_GT(box.graph().size(), 1.5 * nodes);
  EXPECT_GT(box.mesh().vertices.size(), 1.5 * vertices);
  for (const FrameMotions& frame : box.history().All()) {
    EXPECT_EQ(frame.motions.size(), box.graph().positions.size());
  }
}

TEST(Surface, KnowsWhichNodesAreSeen) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  const auto seen = [&](const LiveView& live) {
    const std::vector<char> nodes = box.SeenNodes(live);
    EXPECT_EQ(static_cast<int>(nodes.size()), box.graph().size());
    return static_cast<double>(std::count(nodes.begin(), nodes.end(), true)) /
           box.graph().size();
  };
  EXPECT_GT(seen(ViewWithBox(kWhole)), 0.7) << "but at depth edges";
  EXPECT_LT(seen(ViewWithBox(kHalf)), 0.6);
  EXPECT_GT(seen(ViewWithBox(kHalf)), 0.3);
  LiveView other = ViewWithBox(kWhole);
  other.labels.setTo(0);
  EXPECT_EQ(seen(other), 0) << "another surface is there";
  ApplyRigidMotion(MakeMotion({0, 0, 0}, {0, 0, 0.2}), box.mutable_graph());
  EXPECT_EQ(seen(ViewWithBox(kWhole)), 0) << "it is hidden behind that";
  box.RecordMotions(4, true, box.SeenNodes(ViewWithBox(kWhole)));
  EXPECT_FALSE(box.history().At(0).Saw(0));
  Surface rigid = MakeBox(SurfaceKind::kRigid);
  ASSERT_TRUE(rigid.Initialize(ViewWithBox(kWhole)));
  EXPECT_EQ(rigid.SeenNodes(other), std::vector<char>{true});
}

TEST(Surface, BeginsAnewUnderItsIdAndKeepsWhatItWas) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  box.RecordMotions(4, true);
  const std::size_t vertices = box.mesh().vertices.size();
  const int nodes = box.graph().size();
  LiveView empty = ViewWithBox(kHalf);
  empty.labels.setTo(0);
  EXPECT_FALSE(box.Reanchor(empty));
  EXPECT_EQ(box.mesh().vertices.size(), vertices);
  ASSERT_TRUE(box.Reanchor(ViewWithBox(kWhole)));
  EXPECT_EQ(box.id(), 1);
  EXPECT_EQ(box.first_frame(), 4);
  EXPECT_GT(box.mesh().vertices.size(), 1.5 * vertices);
  EXPECT_TRUE(box.history().empty());
  box.RecordMotions(5, true);
  box.FinishMesh();
  const SurfaceModel model = box.Model();
  ASSERT_EQ(model.graph.parts.size(), 2u);
  EXPECT_EQ(model.graph.parts[0].end_frame, 5);
  EXPECT_EQ(model.graph.parts[1].node, nodes);
  EXPECT_EQ(model.graph.parts[1].first_frame, 5);
  EXPECT_EQ(model.history.size(), 2);
  EXPECT_EQ(model.graph.size(), nodes + box.graph().size());
}

TEST(Surface, ForgetsWhatHangsInFreeSpaceButForTheFramesSoFar) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  const auto width = [](const TriangleMesh& mesh) {
    float low = 9, high = -9;
    for (const auto& v : mesh.vertices) {
      low = std::min(low, v.x());
      high = std::max(high, v.x());
    }
    return high - low;
  };
  const auto fuse = [&](const LiveView& live, int frame) {
    const int forgotten = box.Fuse(live);
    box.UpdateMesh();
    box.RecordMotions(frame, true);
    return forgotten;
  };
  for (int frame = 4; frame < 20; ++frame) {
    EXPECT_EQ(fuse(ViewWithBox(kWhole), frame), 0);
  }
  const int nodes = box.graph().size();
  const float whole = width(box.mesh());
  // Its right half is gone, the wall is seen there.
  EXPECT_EQ(fuse(ViewWithBox(kHalf), 20), 0);
  EXPECT_EQ(fuse(ViewWithBox(kHalf), 21), 0);
  EXPECT_GT(width(box.mesh()), 0.9f * whole);
  EXPECT_GT(fuse(ViewWithBox(kHalf), 22), nodes / 4);
  EXPECT_NEAR(width(box.mesh()), whole / 2, 0.1f * whole);
  EXPECT_LT(box.graph().size(), 0.8 * nodes);
  EXPECT_EQ(fuse(ViewWithBox(kHalf), 23), 0);
  const SurfaceModel model = box.Model();
  ASSERT_EQ(model.graph.parts.size(), 2u);
  EXPECT_EQ(model.graph.parts[0].first_frame, 4);
  EXPECT_EQ(model.graph.parts[0].end_frame, 22);
  EXPECT_EQ(model.graph.parts[1].first_frame, 4);
  EXPECT_EQ(model.graph.parts[1].end_frame, ModelPart::kNoEnd);
  EXPECT_EQ(model.history.size(), 20);
}

/// Carries the nodes right of the middle of kWhole by so many metres.
void MoveRightHalf(float way, Surface* box) {
  DeformationGraph& graph = *box->mutable_graph();
  for (int i = 0; i < graph.size(); ++i) {
    if (SmallCamera().Project(graph.positions[i]).x() > 80) {
      graph.motions[i].translation.x() += way;
    }
  }
}

/// Edges of its graph that cross the middle of kWhole.
int EdgesAcross(const DeformationGraph& graph) {
  const auto right = [&](int node) {
    return SmallCamera().Project(graph.positions[node]).x() > 80;
  };
  int across = 0;
  for (int i = 0; i < graph.size(); ++i) {
    for (const int j : graph.neighbors[i]) across += right(i) && !right(j);
  }
  return across;
}

TEST(Surface, IsTornWhereWhatTouchedMovesApart) {
  constexpr int kWay = 40;  // Pixels, 0.3 m.
  cv::Mat_<float> depth = WallDepth(SmallCamera(), 1.5);
  cv::Mat_<std::uint8_t> apart(depth.size(), std::uint8_t{0});
  const cv::Rect right(80, 40, 30, 40);
  apart(kHalf) = 1;
  apart(right + cv::Point(kWay, 0)) = 1;
  depth.setTo(1.0f, apart);
  LiveView live = MakeLiveView(SmallCamera(), depth,
                               PlainColor(SmallCamera(), {10, 200, 30}));
  live.labels.setTo(1, apart);
  const auto fused = [&](bool tear) {
    GraphOptions options;
    if (!tear) options.tear_voxels = 0;
    Surface box(1, "person", SurfaceKind::kNonRigid, 4, SurfaceOptions(),
                options);
    EXPECT_TRUE(box.Initialize(ViewWithBox(kWhole)));
    for (int frame = 4; frame < 8; ++frame) {
      box.Fuse(ViewWithBox(kWhole));
      box.UpdateMesh();
      EXPECT_EQ(box.Tear(ViewWithBox(kWhole)), 0);
      box.RecordMotions(frame, true);
    }
    const int across = EdgesAcross(box.graph());
    EXPECT_GT(across, 20);
    MoveRightHalf(kWay / 130.0f, &box);
    EXPECT_EQ(box.Tear(live) > 0, tear);
    // Parts are tied by few edges.
    EXPECT_EQ(EdgesAcross(box.graph()) < across / 2, tear);
    return StretchedTriangles(kStretchedEdge, box.mesh().triangles,
                              box.WarpedVertices())
        .size();
  };
  EXPECT_GT(fused(false), 100u);
  EXPECT_EQ(fused(true), 0u);
}

TEST(Surface, IsNotTornWhereItIsHidden) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  // Something is in front of the gap.
  MoveRightHalf(0.3f, &box);
  cv::Mat_<float> near = WallDepth(SmallCamera(), 0.6);
  const LiveView hidden = MakeLiveView(
      SmallCamera(), near, PlainColor(SmallCamera(), {10, 200, 30}));
  EXPECT_GT(StretchedTriangles(kStretchedEdge, box.mesh().triangles,
                               box.WarpedVertices())
                .size(),
            100u);
  EXPECT_EQ(box.Tear(hidden), 0);
}

TEST(Surface, GrowsAndForgetsInOneFrame) {
  const cv::Rect left(20, 40, 30, 40), right(80, 40, 30, 40);
  const cv::Rect middle(50, 40, 30, 40);
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(middle | right)));
  box.RecordMotions(4, true);
  const auto fuse = [&](const cv::Rect& area, int frame) {
    const int forgotten = box.Fuse(ViewWithBox(area));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
    return forgotten;
  };
  // Its right third goes; its left third comes when that is forgotten.
  EXPECT_EQ(fuse(middle, 5), 0);
  EXPECT_EQ(fuse(middle, 6), 0);
  const PinholeCamera camera = SmallCamera();
  const auto grown = [&] {
    int vertices = 0;
    for (const Eigen::Vector3f& v : box.mesh().vertices) {
      vertices += camera.Project(v).x() < middle.x - 2;
    }
    return vertices;
  };
  EXPECT_LT(grown(), 10);
  EXPECT_GT(fuse(left | middle, 7), 0);
  EXPECT_GT(grown(), 100);
  for (int frame = 8; frame < 12; ++frame) {
    EXPECT_EQ(fuse(left | middle, frame), 0);
  }
  const SurfaceModel model = box.Model();
  ASSERT_EQ(model.graph.parts.size(), 2u);
  EXPECT_EQ(model.graph.parts[1].node, model.graph.size() - box.graph().size());
  EXPECT_GT(grown(), 100);
  for (const Eigen::Vector3f& v : box.mesh().vertices) {
    EXPECT_LT(camera.Project(v).x(), right.x + 2);
  }
}

TEST(Surface, RefutedPartsGoOnAfterACheckpoint) {
  Surface whole = MakeBox(SurfaceKind::kNonRigid);
  Surface resumed = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(whole.Initialize(ViewWithBox(kWhole)));
  for (int frame = 4; frame < 16; ++frame) {
    // The right half is gone from frame 8 on: forgotten in frame 10.
    const LiveView live = ViewWithBox(frame < 8 ? kWhole : kHalf);
    if (frame == 10 || frame == 12) {
      std::stringstream stream;
      ArchiveWriter writer(&stream);
      writer(whole);
      writer.Flush();
      resumed = MakeBox(SurfaceKind::kNonRigid);
      ArchiveReader reader(&stream, stream.str().size(), "state");
      reader(resumed);
    }
    const int forgotten = whole.Fuse(live);
    EXPECT_EQ(forgotten > 0, frame == 10);
    whole.UpdateMesh();
    whole.RecordMotions(frame, true);
    if (frame < 10) continue;
    EXPECT_EQ(resumed.Fuse(live), forgotten) << frame;
    resumed.UpdateMesh();
    resumed.RecordMotions(frame, true);
  }
  const SurfaceModel a = whole.Model(), b = resumed.Model();
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.graph.positions, b.graph.positions);
  ASSERT_EQ(b.graph.parts.size(), 2u);
  EXPECT_EQ(b.graph.parts[0].end_frame, 10);
  EXPECT_EQ(b.graph.parts[1].node, a.graph.parts[1].node);
  EXPECT_EQ(b.history.size(), a.history.size());
}

TEST(Surface, ForgetsWhatWasSeenSeldomAndIsHiddenByItself) {
  const auto forgotten_in = [](int sights) {
    GraphOptions options;
    options.confirmed_frames = 4;
    options.unconfirmed_frames = 5;
    Surface box(1, "person", SurfaceKind::kNonRigid, 4, SurfaceOptions(),
                options);
    EXPECT_TRUE(box.Initialize(ViewWithBox(kWhole)));
    for (int i = 0; i < sights; ++i)
      EXPECT_EQ(box.Fuse(ViewWithBox(kWhole)), 0);
    box.UpdateMesh();
    // The right half goes behind the left one.
    DeformationGraph* graph = box.mutable_graph();
    for (int i = 0; i < graph->size(); ++i) {
      if (graph->positions[i].x() < 0) continue;
      graph->motions[i].translation = Eigen::Vector3d(-0.25, 0, 0.2);
    }
    int frame = 1;
    while (frame <= 20 && box.Fuse(ViewWithBox(kHalf)) == 0) ++frame;
    return frame;
  };
  EXPECT_EQ(forgotten_in(3), 6) << "in the frame after five";
  EXPECT_EQ(forgotten_in(8), 11) << "it was seen for longer";
}

TEST(Surface, ZeroFramesForgetNoParts) {
  GraphOptions graph;
  graph.refuted_frames = 0;
  Surface box(1, "box", SurfaceKind::kNonRigid, 4, SurfaceOptions(), graph);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  for (int frame = 4; frame < 12; ++frame) {
    EXPECT_EQ(box.Fuse(ViewWithBox(frame < 8 ? kWhole : kHalf)), 0);
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  EXPECT_TRUE(box.Model().graph.parts.empty());
}

TEST(Surface, KeepsWhatIsHiddenOrTakenForAnother) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  box.RecordMotions(4, true);
  const cv::Rect right(80, 40, 30, 40);
  for (int frame = 5; frame < 12; ++frame) {
    LiveView live = ViewWithBox(kWhole);
    live.labels(right).setTo(2);
    if (frame % 2 == 0) live.depth(right).setTo(0.6f);
    EXPECT_EQ(box.Fuse(live), 0);
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
}

TEST(Surface, AGraphOfFewNodesNeedsNoMoreBlocks) {
  std::vector<std::size_t> blocks;
  for (const int max_nodes : {2000, 1}) {
    GraphOptions graph;
    graph.max_nodes = max_nodes;
    Surface box(1, "box", SurfaceKind::kNonRigid, 4, SurfaceOptions(), graph);
    ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
    box.RecordMotions(4, true);
    box.Fuse(ViewWithBox(kWhole));
    box.UpdateMesh();
    blocks.push_back(box.volume().leaf_count());
  }
  EXPECT_LE(blocks[1], blocks[0]);
}

TEST(Surface, PartsAstrayDoNotCopyWhatIsModelledElsewhere) {
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  const auto right_end = [&] {
    float x = -1;
    for (const auto& v : box.mesh().vertices) x = std::max(x, v.x());
    return x;
  };
  const float before = right_end();
  // The nodes of the right end go astray: what is empty beside them comes to
  // lie upon the model of the middle.
  DeformationGraph* graph = box.mutable_graph();
  for (int i = 0; i < graph->size(); ++i) {
    if (graph->positions[i].x() > before - 0.12) {
      graph->motions[i].translation = {-0.2, 0, 0};
    }
  }
  for (int frame = 5; frame < 15; ++frame) {
    box.Fuse(ViewWithBox(kWhole));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  EXPECT_LT(right_end(), before + 0.02);
}

TEST(Surface, ForgetsTheNodesOfWhatIsRefuted) {
  // The right half of the box is gone; the wall behind it is seen through it.
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kWhole)));
  for (int frame = 0; frame < 5; ++frame) {
    box.Fuse(ViewWithBox(kWhole));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  const int nodes = box.graph().size();
  for (int frame = 5; frame < 25; ++frame) {
    box.Fuse(ViewWithBox(kHalf));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  EXPECT_LT(box.graph().size(), 0.9 * nodes);
  for (const FrameMotions& frame : box.history().All()) {
    EXPECT_EQ(static_cast<int>(frame.motions.size()), box.graph().size());
  }
  const SkinningIndex index(box.graph(), 6);
  const MeshSkinning anew(index, box.mesh().vertices);
  for (std::size_t i = 0; i < box.mesh().vertices.size(); ++i) {
    EXPECT_EQ(box.mesh_skinning()[i].nodes, anew.skinning()[i].nodes) << i;
    EXPECT_EQ(box.mesh_skinning()[i].weights, anew.skinning()[i].weights) << i;
  }
}

TEST(Surface, VerticesMoveWithTheNodes) {
  for (const SurfaceKind kind : {SurfaceKind::kRigid, SurfaceKind::kNonRigid}) {
    Surface box = MakeBox(kind);
    ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
    const Rigid3d motion = MakeMotion({0.1, 0.2, 0}, {0.3, 0, 0.1});
    ApplyRigidMotion(motion, box.mutable_graph());
    const std::vector<Eigen::Vector3f> warped = box.WarpedVertices();
    for (std::size_t i = 0; i < warped.size(); i += 17) {
      EXPECT_LT(
          (warped[i] - motion.cast<float>() * box.mesh().vertices[i]).norm(),
          1e-5);
    }
  }
}

TEST(Surface, IsWrittenWithConstantVertexOrder) {
  const TemporaryFolder folder;
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  box.RecordMotions(4, true);
  ApplyRigidMotion(MakeMotion({0, 0, 0}, {0.5, 0, 0}), box.mutable_graph());
  box.RecordMotions(5, true);
  box.RecordMotions(6, false);
  WriteSurface(RunPaths(folder.Make("run")), box, box.Model(),
               {/*every=*/2, /*whole=*/false});
  const std::string at = "run/surfaces/001_teddy_bear/";
  EXPECT_FALSE(folder.Has(at + "warped/000005.ply"));
  const TriangleMesh rest = ReadPly(folder / (at + "mesh.ply"));
  const TriangleMesh born = ReadPly(folder / (at + "warped/000004.ply"));
  const TriangleMesh later = ReadPly(folder / (at + "warped/000006.ply"));
  EXPECT_EQ(later.triangles, rest.triangles);
  ASSERT_EQ(later.vertices.size(), rest.vertices.size());
  for (std::size_t i = 0; i < rest.vertices.size(); ++i) {
    EXPECT_LT((born.vertices[i] - rest.vertices[i]).norm(), 1e-5);
    EXPECT_NEAR(later.vertices[i].x() - rest.vertices[i].x(), 0.5, 1e-5);
  }
  EXPECT_GT(TsdfVolume::Read(folder / (at + "tsdf.vdb")).leaf_count(), 0u);
  EXPECT_EQ(ReadGraph(folder / (at + "graph.json"), nullptr).size(),
            box.graph().size());
  EXPECT_EQ(ReadMotions(folder / (at + "motions.bin")).size(), 3);
}

TEST(Surface, WarpedMeshesHoldWhatWasSeenByThen) {
  const TemporaryFolder folder;
  Surface box = MakeBox(SurfaceKind::kNonRigid);
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  box.RecordMotions(4, true);
  for (int frame = 5; frame < 10; ++frame) {
    box.Fuse(ViewWithBox(kWhole));
    box.UpdateMesh();
    box.RecordMotions(frame, true);
  }
  box.FinishMesh();
  EXPECT_EQ(box.graph().first_seen.front(), 4);
  EXPECT_GT(box.graph().first_seen.back(), 4);
  EXPECT_EQ(static_cast<int>(box.graph().first_seen.size()),
            box.graph().size());
  const auto warped = [&](bool whole, const std::string& frame) {
    const std::string run = whole ? "whole" : "seen";
    WriteSurface(RunPaths(folder.Make(run)), box, box.Model(),
                 {/*every=*/1, whole});
    return ReadPly(folder /
                   (run + "/surfaces/001_teddy_bear/warped/" + frame + ".ply"));
  };
  const std::size_t all = box.mesh().triangles.size();
  const TriangleMesh first = warped(false, "000004");
  EXPECT_EQ(first.vertices.size(), box.mesh().vertices.size());
  EXPECT_GT(first.triangles.size(), 0.35 * all);
  EXPECT_LT(first.triangles.size(), 0.65 * all) << "half of it was in view";
  EXPECT_EQ(warped(false, "000009").triangles.size(), all);
  EXPECT_EQ(warped(true, "000004").triangles.size(), all);
}

TEST(Surface, NewNodesAreSeenFromTheirFrameOn) {
  Surface box(1, "box", SurfaceKind::kNonRigid, 4, SurfaceOptions());
  ASSERT_TRUE(box.Initialize(ViewWithBox(kHalf)));
  box.RecordMotions(4, true);
  const int nodes = box.graph().size();
  box.Fuse(ViewWithBox(kWhole));
  box.UpdateMesh();
  box.RecordMotions(7, true);
  const std::vector<int>& first_seen = box.graph().first_seen;
  ASSERT_GT(box.graph().size(), 1.5 * nodes);
  ASSERT_EQ(static_cast<int>(first_seen.size()), box.graph().size());
  EXPECT_EQ(std::count(first_seen.begin(), first_seen.end(), 4), nodes);
  EXPECT_EQ(std::count(first_seen.begin(), first_seen.end(), 7),
            box.graph().size() - nodes);
}

/// Background and box as a scene.
SurfaceMap Scene() {
  SurfaceMap surfaces;
  surfaces[0] = std::make_unique<Surface>(0, "background", SurfaceKind::kRigid,
                                          0, SurfaceOptions());
  surfaces[1] = std::make_unique<Surface>(1, "box", SurfaceKind::kNonRigid, 0,
                                          SurfaceOptions());
  for (auto& [id, surface] : surfaces) {
    EXPECT_TRUE(surface->Initialize(ViewWithBox(kWhole)));
  }
  return surfaces;
}

TEST(ModelRendering, ReunitesAllSurfacesInTheCameraFrame) {
  const SurfaceMap surfaces = Scene();
  const SceneRendering scene =
      RenderScene(surfaces, SmallCamera(), RayCastOptions());
  EXPECT_EQ(scene.labels(60, 80), 1);
  EXPECT_NEAR(scene.map.points(60, 80)[2], 1.0, 0.005);
  EXPECT_LT(scene.map.normals(60, 80)[2], -0.95);
  EXPECT_NEAR(scene.map.color(60, 80)[1], 200, 3);  // BGR.
  EXPECT_EQ(scene.labels(20, 20), 0);
  EXPECT_NEAR(scene.map.points(20, 20)[2], 1.5, 0.005);
}

TEST(ModelRendering, WhatMovesBehindTheRoomIsHidden) {
  const SurfaceMap surfaces = Scene();
  ApplyRigidMotion(MakeMotion({0, 0, 0}, {-0.05, 0, 1}),
                   surfaces.at(1)->mutable_graph());
  const SceneRendering scene =
      RenderScene(surfaces, SmallCamera(), RayCastOptions());
  // The room has a hole where the box had hidden it.
  EXPECT_EQ(scene.labels(60, 30), 0);
  ApplyRigidMotion(MakeMotion({0, 0, 0}, {-0.3, 0, -1}),
                   surfaces.at(1)->mutable_graph());
  EXPECT_EQ(
      RenderScene(surfaces, SmallCamera(), RayCastOptions()).labels(60, 40), 1);
}

TEST(ModelRendering, PredictionHasTheFullSize) {
  const SurfaceMap surfaces = Scene();
  const MeshRendering rendering =
      RenderMeshes(surfaces, SmallCamera().Subsampled(2));
  const SurfacePrediction prediction =
      ToPrediction(rendering, {}, SmallCamera());
  EXPECT_EQ(prediction.labels.size(), cv::Size(160, 120));
  EXPECT_EQ(prediction.labels(60, 80), 1);
  EXPECT_NEAR(prediction.depth(60, 80), 1.0, 0.005);
  EXPECT_EQ(prediction.labels(10, 10), 0);
  EXPECT_EQ(prediction.depth(10, 10), 0);
  EXPECT_TRUE(prediction.background.empty());
}

TEST(ModelRendering, PredictionHasTheBackgroundBehindTheSurfaces) {
  const SurfaceMap surfaces = Scene();
  const MeshRendering rendering =
      RenderMeshes(surfaces, SmallCamera().Subsampled(2));
  const SurfacePrediction prediction = ToPrediction(
      rendering, RenderBackground(surfaces, SmallCamera(), 2, RayCastOptions()),
      SmallCamera());
  EXPECT_EQ(prediction.labels(60, 80), 1);
  EXPECT_NEAR(prediction.depth(60, 80), 1.0, 0.005);
  EXPECT_EQ(prediction.labels(10, 10), 0);
  EXPECT_NEAR(prediction.depth(10, 10), 1.5, 0.01);
  EXPECT_NEAR(prediction.background(10, 10), 1.5, 0.01);
}

TEST(ModelRendering, AloneNothingHidesASurface) {
  SurfaceMap surfaces = Scene();
  EXPECT_EQ(RenderMeshes(surfaces, SmallCamera()).first_triangle.count(1), 1u);
  const MeshRendering alone = RenderAlone(*surfaces.at(1), SmallCamera());
  EXPECT_NEAR(alone.raster.depth(60, 80), 1.0, 0.005);
  surfaces.at(1)->set_inactive(true);
  EXPECT_EQ(RenderMeshes(surfaces, SmallCamera()).first_triangle.count(1), 0u);
}

TEST(ModelRendering, SamplesLieOnTheSurfaceAtTheirPixels) {
  const SurfaceMap surfaces = Scene();
  const Rigid3d motion = MakeMotion({0, 0.1, 0}, {0.02, 0, 0.05});
  for (const auto& [id, surface] : surfaces) {
    ApplyRigidMotion(motion, surface->mutable_graph());
  }
  const MeshRendering rendering =
      RenderMeshes(surfaces, SmallCamera().Subsampled(2));
  const auto check = [&](const std::vector<ModelSample>& samples, double z) {
    ASSERT_GT(samples.size(), 300u);
    for (const ModelSample& sample : samples) {
      EXPECT_NEAR(sample.point.z(), z, 0.01);
      EXPECT_LT(sample.normal.z(), -0.9);
      EXPECT_EQ(sample.u % 2 + sample.v % 2, 0);
      const Eigen::Vector2f pixel =
          SmallCamera().Project<float>(motion.cast<float>() * sample.point);
      EXPECT_NEAR(pixel.x(), sample.u, 0.05);
      EXPECT_NEAR(pixel.y(), sample.v, 0.05);
    }
  };
  check(VisibleSamples(rendering, *surfaces.at(1), 2), 1.0);
  check(BackgroundSamples(
            RenderBackground(surfaces, SmallCamera(), 2, RayCastOptions()),
            motion, 2),
        1.5);
}

TEST(SurfaceOptions, RefuseValuesOutOfRange) {
  SurfaceOptions options;
  options.min_mesh_weight = -1;
  ExpectInputError([&] { options.Check(); }, "mesh_weight");
  // Beyond, fusion would not tell that a mesh has to be made anew.
  options.min_mesh_weight = 8.5;
  ExpectInputError([&] { options.Check(); },
                   "mesh_weight = 8.5: expected 0..8, not 0");
  options.min_mesh_weight = MeshExtractor::kMaxMinWeight;
  options.Check();
  options = SurfaceOptions();
  options.tsdf.truncation = 0;
  ExpectInputError([&] { options.Check(); }, "truncation = 0");
}

}  // namespace
}  // namespace splitfusion
