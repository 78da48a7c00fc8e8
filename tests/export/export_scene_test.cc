// What of a run is exported, and where it is.

#include "splitfusion/lib/export/export_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/export/appearance.h"
#include "splitfusion/lib/export/influences.h"
#include "support/expect_input_error.h"
#include "support/joined_run.h"
#include "support/motion_frames.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> NamesOf(const ExportScene& scene) {
  std::vector<std::string> names;
  for (const ExportSurface& surface : scene.surfaces) {
    names.push_back(surface.name);
  }
  return names;
}

std::vector<int> FramesWith(const ExportSurface& surface) {
  std::vector<int> frames;
  for (const ExportMoment& moment : surface.moments) {
    frames.push_back(moment.frame);
  }
  return frames;
}

/// Farthest distance of the vertices in all frames from the plate, bent as it
/// is; `map` brings the world of the run into the space of the export.
double FarthestFromPlate(const ExportSurface& surface, const BentPlate& plate,
                         const Eigen::Vector3f& signs) {
  const TriangleMesh flat = plate.PlateAt(0);
  double farthest = 0;
  for (const ExportMoment& moment : surface.moments) {
    const TriangleMesh mesh = surface.At(moment);
    const TriangleMesh truth = plate.PlateAt(moment.frame);
    EXPECT_EQ(mesh.vertices.size(), truth.vertices.size());
    for (std::size_t i = 0; i < truth.vertices.size(); ++i) {
      const Eigen::Vector3f expected = signs.cwiseProduct(truth.vertices[i]);
      farthest =
          std::max<double>(farthest, (mesh.vertices[i] - expected).norm());
    }
  }
  return farthest;
}

class ExportSceneTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  BentPlate plate_;
  ExportOptions options_;
};

TEST_F(ExportSceneTest, CarriesSurfacesIntoTheWorld) {
  plate_.WriteRun(folder_ / "run");
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  EXPECT_THAT(NamesOf(scene), ElementsAre("000_background", "001_thin_plate"));
  // Nodes bend it piece by piece.
  EXPECT_LT(FarthestFromPlate(scene.surfaces[1], plate_, {1, 1, 1}), 2e-3);
  EXPECT_TRUE(scene.surfaces[0].IsStill(scene.frames.size()));
  EXPECT_FALSE(scene.surfaces[1].IsStill(scene.frames.size()));
  EXPECT_NEAR(scene.TimeOf(3), 0.1, 1e-5);
  options_.y_up = true;
  EXPECT_LT(
      FarthestFromPlate(ReadExportScene(folder_ / "run", options_).surfaces[1],
                        plate_, {1, -1, -1}),
      2e-3);
  options_.in_world = false;
  const ExportScene seen = ReadExportScene(folder_ / "run", options_);
  EXPECT_FALSE(seen.surfaces[0].IsStill(seen.frames.size()));
}

TEST_F(ExportSceneTest, ModelsAndRefutedPartsAreApart) {
  JoinedRun().Write(folder_ / "run");
  options_.refuted = false;
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  EXPECT_THAT(NamesOf(scene), ElementsAre("000_background", "001_thin_plate_1",
                                          "001_thin_plate_2", "002_ball"));
  EXPECT_THAT(FramesWith(scene.surfaces[1]), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(FramesWith(scene.surfaces[2]), ElementsAre(6, 7, 9, 10, 11))
      << "inactive in frame 8";
  for (const int i : {1, 2}) {
    EXPECT_LT(FarthestFromPlate(scene.surfaces[i], plate_, {1, 1, 1}), 2e-3);
    EXPECT_EQ(scene.surfaces[i].source.front(), 41 * 31 * i);
  }
  options_.refuted = true;
  const ExportScene all = ReadExportScene(folder_ / "run", options_);
  EXPECT_EQ(all.surfaces[1].name, "001_thin_plate_refuted_1");
  EXPECT_THAT(FramesWith(all.surfaces[1]), ElementsAre(1, 2));
  EXPECT_LT(FarthestFromPlate(all.surfaces[1], plate_, {1, 1, 1}), 2e-3);
}

TEST_F(ExportSceneTest, TakesEveryNthFrameAndSomeSurfaces) {
  JoinedRun().Write(folder_ / "run");
  options_.every = 5;
  options_.refuted = false;
  options_.surfaces = {2, 1};
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  EXPECT_EQ(scene.frames.size(), 3u);
  EXPECT_THAT(NamesOf(scene),
              ElementsAre("001_thin_plate_1", "001_thin_plate_2", "002_ball"));
  EXPECT_THAT(FramesWith(scene.surfaces[2]), ElementsAre(5));
  EXPECT_EQ(scene.surfaces[2].moments[0].place, 1u);
  EXPECT_TRUE(scene.absent.empty());
  options_.every = 10;  // The ball is there in frames 4 to 8.
  EXPECT_THAT(ReadExportScene(folder_ / "run", options_).absent,
              ElementsAre("002_ball"));
  options_.surfaces = {3};
  ExpectInputError([&] { ReadExportScene(folder_ / "run", options_); },
                   "surface 3: expected one of 0, 1, 2");
}

TEST_F(ExportSceneTest, LeavesStretchedTrianglesOut) {
  plate_.curvature_step = 0;
  plate_.WriteRun(folder_ / "run");
  const std::string folder = folder_ / "run/surfaces/001_thin_plate";
  int nodes = 0;
  MotionHistory motions = ReadMotions(folder + "/motions.bin", &nodes);
  // One node is torn away, in one frame.
  EditFrame(
      5, [](FrameMotions& f) { f.motions[4].translation.z() -= 0.3; },
      &motions);
  WriteMotions(folder + "/motions.bin", motions, nodes);
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  const ExportSurface& cut = scene.surfaces[1];
  EXPECT_GT(cut.stretched_triangles, 0);
  options_.cut_stretched = false;
  const ExportScene whole = ReadExportScene(folder_ / "run", options_);
  EXPECT_EQ(whole.surfaces[1].stretched_triangles, 0);
  EXPECT_EQ(whole.surfaces[1].mesh.triangles.size(),
            cut.mesh.triangles.size() + cut.stretched_triangles);
}

/// Area of the triangles that are shown in a frame, canonical, square metres.
double AreaShown(const std::vector<ExportSurface>& pieces, int frame) {
  double area = 0;
  for (const ExportSurface& piece : pieces) {
    for (const ExportMoment& moment : piece.moments) {
      if (moment.frame != frame) continue;
      for (const Eigen::Vector3i& t : piece.mesh.triangles) {
        const auto& p = piece.mesh.vertices;
        area += (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm() / 2;
      }
    }
  }
  return area;
}

TEST_F(ExportSceneTest, WhatWasSeenLaterAppearsThen) {
  plate_.WriteRun(folder_ / "run");
  const std::string file = folder_ / "run/surfaces/001_thin_plate/graph.json";
  int neighbors = 0;
  DeformationGraph graph = ReadGraph(file, &neighbors);
  // The right half was seen in frame 5 at first.
  graph.node_spacing = 0.01;
  for (const Eigen::Vector3d& g : graph.positions) {
    graph.first_seen.push_back(g.x() > 0.01 ? 5 : 0);
  }
  WriteGraph(file, graph, neighbors);
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  const ExportSurface& whole = scene.surfaces[1];
  const std::vector<ExportSurface> exact = SplitByAppearance(whole, 1);
  ASSERT_EQ(exact.size(), 2u);
  EXPECT_EQ(exact[1].name, "001_thin_plate_from_000005");
  EXPECT_EQ(FramesWith(exact[1]).front(), 5);
  EXPECT_EQ(FramesWith(exact[0]).size(), 12u);
  const double area = AreaShown({whole}, 0);
  EXPECT_NEAR(AreaShown(exact, 4), area / 2, area / 8);
  EXPECT_NEAR(AreaShown(exact, 5), area, 1e-6);
  EXPECT_LT(exact[0].graph.size(), whole.graph.size());
  for (const ExportSurface& piece : exact) {
    const TriangleMesh mesh = piece.At(piece.moments.back());
    const TriangleMesh all = whole.At(whole.moments.back());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      EXPECT_LT((mesh.vertices[i] - all.vertices[piece.source[i]]).norm(),
                1e-6);
    }
  }
  const std::vector<ExportSurface> coarse = SplitByAppearance(whole, 4);
  ASSERT_EQ(coarse.size(), 2u);
  EXPECT_EQ(FramesWith(coarse[1]).front(), 8);
  EXPECT_EQ(FramesWith(SplitByAppearance(whole, 100)[1]).front(), 11);
  EXPECT_EQ(SplitByAppearance(scene.surfaces[0], 1).size(), 1u);
}

TEST_F(ExportSceneTest, HeaviestInfluencesComeFirstAndSumToOne) {
  plate_.WriteRun(folder_ / "run");
  const ExportScene scene = ReadExportScene(folder_ / "run", options_);
  const ExportSurface& surface = scene.surfaces[1];
  const std::vector<Skinning> all = HeaviestFirst(surface.skinning, 8);
  const std::vector<Skinning> four = HeaviestFirst(surface.skinning, 4);
  for (std::size_t i = 0; i < four.size(); ++i) {
    EXPECT_EQ(all[i].count, surface.skinning[i].count);
    ASSERT_EQ(four[i].count, 4);
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_EQ(four[i].nodes[k], all[i].nodes[k]);
      if (k > 0) {
        EXPECT_LE(four[i].weights[k], four[i].weights[k - 1]);
      }
      sum += four[i].weights[k];
    }
    EXPECT_NEAR(sum, 1, 1e-6);
  }
  EXPECT_LT(ErrorOf(surface, all).largest, 1e-6);
  const InfluenceError error = ErrorOf(surface, four);
  EXPECT_GT(error.RootMeanSquare(), 0);
  EXPECT_GT(error.largest, error.RootMeanSquare());
  EXPECT_LT(error.largest, 0.01);
}

}  // namespace
}  // namespace splitfusion
