// Animated glTF, as a viewer shows it.

#include "splitfusion/lib/export/gltf_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/expect_input_error.h"
#include "support/glb_reader.h"
#include "support/joined_run.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class GltfSceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    JoinedRun().Write(folder_ / "run");
    options_.y_up = true;
  }

  ExportScene Scene() const {
    return ReadExportScene(folder_ / "run", options_);
  }

  /// Volume by which a node's matrix scales, 0 where it hides.
  static double Scale(const GlbReader& file, const std::string& node,
                      int frame) {
    return file.MatrixAt(file.Node(node), frame / 30.0)
        .topLeftCorner<3, 3>()
        .determinant();
  }

  /// Farthest distance from the export's own meshes of a surface.
  static double Farthest(const GlbReader& file, const ExportScene& scene,
                         const ExportSurface& surface) {
    const int node = file.Node(surface.name);
    double farthest = 0;
    for (const ExportMoment& moment : surface.moments) {
      const TriangleMesh mesh = surface.At(moment);
      const auto vertices = file.VerticesAt(node, scene.TimeOf(moment.place));
      EXPECT_EQ(vertices.size(), mesh.vertices.size());
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        farthest = std::max(
            farthest, (vertices[i] - mesh.vertices[i].cast<double>()).norm());
      }
    }
    return farthest;
  }

  TemporaryFolder folder_;
  ExportOptions options_;
};

TEST_F(GltfSceneTest, SurfacesMoveByJointsOrAsTheyAre) {
  const ExportScene scene = Scene();
  const InfluenceError error = WriteGltf(folder_ / "a.glb", scene, {});
  EXPECT_LT(error.largest, 1e-6);
  const GlbReader file(folder_ / "a.glb");
  for (const ExportSurface& surface : scene.surfaces) {
    EXPECT_LT(Farthest(file, scene, surface), 1e-5) << surface.name;
  }
  EXPECT_EQ(file.json()["skins"].size(), 3u)
      << "the ball and the wall have none";
  const auto& extras =
      file.json()["nodes"][file.Node("001_thin_plate_2")]["extras"];
  EXPECT_EQ(extras["surface"], 1);
  EXPECT_EQ(extras["label"], "thin_plate");
  EXPECT_EQ(file.Source(file.Node("001_thin_plate_2")).front(), 2 * 41 * 31);
  EXPECT_EQ(extras["first_frame"], 6);
}

TEST_F(GltfSceneTest, WhatIsNotThereIsScaledToZero) {
  WriteGltf(folder_ / "a.glb", Scene(), {});
  const GlbReader file(folder_ / "a.glb");
  for (int frame = 0; frame < 12; ++frame) {
    const bool first = frame >= 1 && frame < 6;
    const bool second = frame >= 6 && frame != 8;
    EXPECT_NEAR(Scale(file, "001_thin_plate_1_nodes", frame), first, 1e-9);
    EXPECT_NEAR(Scale(file, "001_thin_plate_2_nodes", frame), second, 1e-9);
    EXPECT_NEAR(Scale(file, "002_ball", frame), frame >= 4 && frame <= 8, 1e-6);
    EXPECT_NEAR(Scale(file, "000_background", frame), 1, 1e-9);
  }
}

TEST_F(GltfSceneTest, TheCameraIsTheRuns) {
  WriteGltf(folder_ / "a.glb", Scene(), {});
  const GlbReader file(folder_ / "a.glb");
  const auto& lens = file.json()["cameras"][0]["perspective"];
  EXPECT_NEAR(lens["aspectRatio"].get<double>(), 160.0 / 120, 1e-9);
  EXPECT_NEAR(lens["yfov"].get<double>(), 2 * std::atan(60.0 / 130), 1e-9);
  const Eigen::Matrix4d pose = file.MatrixAt(file.Node("camera"), 10 / 30.0);
  const Rigid3d expected = BentPlate().WorldFromCamera(10);
  const Eigen::Vector3d flip(1, -1, -1);
  EXPECT_LT(
      (pose.topRightCorner<3, 1>() - flip.cwiseProduct(expected.translation()))
          .norm(),
      1e-6);
  // It looks along its -z, with y up; the run's along z, with y down.
  EXPECT_LT(
      (-pose.block<3, 1>(0, 2) - flip.cwiseProduct(expected.linear().col(2)))
          .norm(),
      1e-6);
  EXPECT_LT(
      (-pose.block<3, 1>(0, 1) - flip.cwiseProduct(expected.linear().col(1)))
          .norm(),
      1e-6);
}

TEST_F(GltfSceneTest, BakedShapesAreTheSame) {
  GltfOptions gltf;
  gltf.bake = true;
  const ExportScene scene = Scene();
  WriteGltf(folder_ / "a.glb", scene, gltf);
  const GlbReader file(folder_ / "a.glb");
  for (const ExportSurface& surface : scene.surfaces) {
    EXPECT_LT(Farthest(file, scene, surface), 1e-5) << surface.name;
  }
  EXPECT_NEAR(Scale(file, "001_thin_plate_2", 8), 0, 1e-9);
  EXPECT_NEAR(Scale(file, "001_thin_plate_2", 9), 1, 1e-9);
}

TEST_F(GltfSceneTest, TakesFourOrEightInfluences) {
  GltfOptions gltf;
  gltf.influences = 6;
  ExpectInputError([&] { WriteGltf(folder_ / "a.glb", Scene(), gltf); },
                   "influences = 6: expected 4 or 8");
  gltf.influences = 4;
  const ExportScene scene = Scene();
  const InfluenceError error = WriteGltf(folder_ / "a.glb", scene, gltf);
  const GlbReader file(folder_ / "a.glb");
  EXPECT_NEAR(std::max({Farthest(file, scene, scene.surfaces[1]),
                        Farthest(file, scene, scene.surfaces[2]),
                        Farthest(file, scene, scene.surfaces[3])}),
              error.largest, 1e-5);
}

}  // namespace
}  // namespace splitfusion
