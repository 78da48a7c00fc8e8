// The program sf_export, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "sf_run_fixture.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/sequence/trajectory.h"
#include "support/bent_plate.h"
#include "support/expect_refused.h"
#include "support/glb_reader.h"
#include "support/repository.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr char kPython[] = "/usr/bin/python3";  // Debian's, which has NumPy.
constexpr double kTenthOfAMillimetre = 1e-4;

/// A run of a walking person, six frames of it.
class SfExport : public SfRun {
 protected:
  void SetUp() override {
    SfRun::SetUp();
    if (!HasProgram("sf_export")) GTEST_SKIP() << "sf_export is not built";
    if (IsSkipped()) return;
    Synthesize("--frames=6");
    const ProgramResult result =
        Run("run", "--pictures_every=0 --warped_every=2 --write_masks=false");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
  }

  ProgramResult Export(const std::string& output,
                       const std::string& arguments = "") const {
    return RunProgram("sf_export", (folder_ / "run") + " --output=" +
                                       (folder_ / output) + " " + arguments);
  }

  TriangleMesh Warped(int frame) const {
    const std::string number = std::to_string(frame);
    return ReadPly(folder_ /
                   ("run/surfaces/001_person/warped/" +
                    std::string(6 - number.size(), '0') + number + ".ply"));
  }

  Trajectory Poses() const {
    return ReadTumTrajectory(folder_ / "run/trajectory.txt");
  }

  double TimeOf(int frame) const {
    const Trajectory poses = Poses();
    return poses[frame].timestamp - poses.front().timestamp;
  }

  /// Of the meshes of the person in a file: which are there in a frame.
  static std::vector<int> MeshesIn(const GlbReader& file, int frame) {
    std::vector<int> nodes;
    for (const auto& node : file.json()["nodes"]) {
      if (!node.contains("mesh") || node["extras"]["surface"] != 1) continue;
      if (node["extras"]["first_frame"] <= frame &&
          node["extras"]["last_frame"] >= frame) {
        nodes.push_back(file.Node(node["name"]));
      }
    }
    return nodes;
  }

  /// Farthest distance of one of them from the warped mesh of a frame, as the
  /// camera of the file sees it; checks normals and colours, too.
  double FarthestOf(const GlbReader& file, int node, int frame,
                    double most_turned) const {
    const TriangleMesh warped = Warped(frame);
    const double time = TimeOf(frame);
    const Eigen::Matrix4d camera_from_world =
        file.MatrixAt(file.Node("camera"), time).inverse();
    const auto in_camera = [&](const Eigen::Vector3d& p, double w) {
      // The camera of glTF has y up and looks along -z.
      const Eigen::Vector4d seen =
          camera_from_world * Eigen::Vector4d(p.x(), p.y(), p.z(), w);
      return Eigen::Vector3d(seen.x(), -seen.y(), -seen.z());
    };
    const auto vertices = file.VerticesAt(node, time);
    const auto normals = file.NormalsAt(node, time);
    const auto colors = file.Colors(node);
    const std::vector<double> source = file.Source(node);
    double farthest = 0, turned = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto k = static_cast<std::size_t>(source[i]);
      farthest = std::max(farthest, (in_camera(vertices[i], 1) -
                                     warped.vertices.at(k).cast<double>())
                                        .norm());
      turned = std::max(
          turned,
          (in_camera(normals[i], 0) - warped.normals[k].cast<double>()).norm());
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(colors[i][c], warped.colors[k][c], 0.5);
      }
    }
    EXPECT_LT(turned, most_turned) << "frame " << frame;
    return farthest;
  }

  /// That of all of them, in three frames. `most_turned`: of normals, radians.
  double Farthest(const GlbReader& file, double most_turned = 0.02) const {
    double farthest = 0;
    for (const int frame : {0, 2, 4}) {
      const std::vector<int> nodes = MeshesIn(file, frame);
      EXPECT_FALSE(nodes.empty());
      for (const int node : nodes) {
        farthest =
            std::max(farthest, FarthestOf(file, node, frame, most_turned));
      }
    }
    return farthest;
  }
};

TEST_F(SfExport, JointsCarryVerticesToWhereTheRunHasThem) {
  const ProgramResult result = Export("scene.glb");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const GlbReader file(folder_ / "scene.glb");
  EXPECT_LT(Farthest(file), kTenthOfAMillimetre);
  const auto& primitive = file.json()["meshes"].back()["primitives"][0];
  EXPECT_TRUE(primitive["attributes"].contains("JOINTS_1")) << "six nodes";
  EXPECT_GE(file.Node("001_person_node_0"), 0);
  EXPECT_EQ(Export("again.glb").exit_code, 0);
  EXPECT_EQ(folder_.Read("scene.glb"), folder_.Read("again.glb"));
  // The room stands still.
  const TriangleMesh room =
      ReadPly(folder_ / "run/surfaces/000_background/mesh.ply");
  const auto vertices = file.VerticesAt(file.Node("000_background"), 0.2);
  ASSERT_EQ(vertices.size(), room.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f& p = room.vertices[i];
    EXPECT_LT((vertices[i] - Eigen::Vector3d(p.x(), -p.y(), -p.z())).norm(),
              kTenthOfAMillimetre);
  }
  EXPECT_EQ(file.Indices(file.Node("000_background")).size(),
            3 * room.triangles.size());
}

TEST_F(SfExport, FourInfluencesAreAsFarOffAsItSays) {
  const ProgramResult result =
      Export("scene.glb", "--influences=4 --surfaces=1");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  std::smatch stated;
  ASSERT_TRUE(std::regex_search(result.output, stated,
                                std::regex("at most ([0-9.]+) mm")))
      << result.output;
  const double largest = std::stod(stated[1]) / 1000;
  EXPECT_GT(largest, 0);
  const GlbReader file(folder_ / "scene.glb");
  const double farthest = Farthest(file, /*most_turned=*/0.3);
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, largest + kTenthOfAMillimetre);
  EXPECT_NEAR(
      file.json()["asset"]["extras"]["influence_error_largest"].get<double>(),
      largest, 1e-6);
  EXPECT_EQ(file.Node("000_background"), -1);
}

TEST_F(SfExport, BakedShapesAreThoseOfTheRun) {
  const ProgramResult result = Export("baked.glb", "--bake --every=2");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const GlbReader file(folder_ / "baked.glb");
  EXPECT_LT(Farthest(file), kTenthOfAMillimetre);
  EXPECT_FALSE(file.json().contains("skins"));
}

TEST_F(SfExport, TheSequenceOfFilesIsAsWarpedMeshesAre) {
  const ProgramResult result =
      Export("meshes/", "--space=camera --every=2 --surfaces=1");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const int frame : {0, 2, 4}) {
    const TriangleMesh warped = Warped(frame);
    const TriangleMesh mesh = ReadPly(
        folder_ / ("meshes/001_person/00000" + std::to_string(frame) + ".ply"));
    EXPECT_EQ(mesh.triangles, warped.triangles);
    ASSERT_EQ(mesh.vertices.size(), warped.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      EXPECT_LT((mesh.vertices[i] - warped.vertices[i]).norm(), 1e-5);
      EXPECT_LT((mesh.normals[i] - warped.normals[i]).norm(), 1e-4);
      EXPECT_EQ(mesh.colors[i], warped.colors[i]);
    }
  }
  EXPECT_FALSE(folder_.Has("meshes/001_person/000001.ply"));
  EXPECT_EQ(Export("meshes", "--as=pcd").exit_code, 2) << "it is there";
  EXPECT_EQ(Export("meshes", "--as=pcd --overwrite --every=2").exit_code, 0);
  EXPECT_TRUE(folder_.Has("meshes/001_person/000004.pcd"));
  EXPECT_TRUE(folder_.Has("meshes/000_background/000000.pcd"));
  EXPECT_FALSE(folder_.Has("meshes/000_background/000004.pcd"))
      << "it stands still";
  EXPECT_FALSE(folder_.Has("meshes/001_person/000002.ply"));
  // Poses of the camera are those of the run.
  ASSERT_EQ(Export("poses.txt", "--as=tum").exit_code, 0);
  EXPECT_EQ(folder_.Read("poses.txt"), folder_.Read("run/trajectory.txt"));
  ASSERT_EQ(Export("kitti.txt", "--as=kitti").exit_code, 0);
  std::istringstream lines(folder_.Read("kitti.txt"));
  for (const TimedPose& pose : Poses()) {
    for (int i = 0; i < 12; ++i) {
      double value = 0;
      lines >> value;
      EXPECT_NEAR(value, pose.world_from_camera(i / 4, i % 4), 1e-6);
    }
  }
  EXPECT_TRUE(lines);
}

TEST_F(SfExport, NumpyReadsWhatCarriesTheVertices) {
  const std::string has_numpy = std::string(kPython) + " -c 'import numpy'";
  if (std::system((has_numpy + " 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "python3-numpy not found";
  }
  ASSERT_EQ(Export("run.npz", "--space=camera").exit_code, 0);
  // As docs/exports.md has it; writes what it finds in frame 4.
  const std::string script = folder_.Write("check.py", R"(
import sys
import numpy as np
run = np.load(sys.argv[1])
of = lambda name: run['001_person/' + name]
m = list(of('frames')).index(4)
g, R, t = of('positions'), of('rotations')[m], of('translations')[m]
by_node = np.einsum('vkij,vkj->vki', R[of('nodes')],
                    of('vertices')[:, None] - g[of('nodes')])
by_node += (t + g)[of('nodes')]
points = (of('weights')[..., None] * by_node).sum(1)
np.savetxt(sys.argv[2], np.hstack([of('source')[:, None], points]))
assert run['world_from_camera'].shape == (6, 4, 4)
assert run['timestamps'].dtype == np.float64 and len(run['frames']) == 6
assert (of('tracked') == 1).any() and of('colors').dtype == np.uint8
)");
  const std::string command = std::string(kPython) + " " + script + " " +
                              (folder_ / "run.npz") + " " +
                              (folder_ / "points.txt");
  ASSERT_EQ(std::system(command.c_str()), 0);
  const TriangleMesh warped = Warped(4);
  std::istringstream points(folder_.Read("points.txt"));
  Eigen::Vector3f p;
  double index = 0;
  int count = 0;
  for (; points >> index >> p.x() >> p.y() >> p.z(); ++count) {
    EXPECT_LT((p - warped.vertices.at(static_cast<int>(index))).norm(),
              kTenthOfAMillimetre);
  }
  EXPECT_GT(count, 1000);
}

TEST_F(SfExport, FilesOfTheRunAreNotWrittenOver) {
  const std::string before = folder_.Read("run/trajectory.txt");
  const ProgramResult result = Export("run/trajectory.txt", "--as=kitti");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(
      result.errors,
      HasSubstr("trajectory.txt: is a file of a run: expected another"));
  EXPECT_EQ(folder_.Read("run/trajectory.txt"), before);
  EXPECT_EQ(Export("run/run.json", "--as=npz").exit_code, 2);
  EXPECT_EQ(Export("run/poses.txt", "--as=kitti").exit_code, 0);
  const auto page = [&](const std::string& name) {
    return RunProgram("sf_report", (folder_ / "run") + " --media=none" +
                                       " --output=" + (folder_ / name));
  };
  EXPECT_EQ(page("run/summary.json").exit_code, 2);
  EXPECT_EQ(page("run/report.html").exit_code, 0);
}

TEST(SfExportMessages, SayWhatIsWrong) {
  if (!HasProgram("sf_export")) GTEST_SKIP() << "sf_export is not built";
  const TemporaryFolder folder;
  BentPlate().WriteRun(folder.Make("run"));
  const std::string run = folder / "run";
  const std::string output = " --output=" + (folder / "out");
  ExpectRefused("sf_export", output + ".glb", "RUN = 0: expected one run");
  ExpectRefused("sf_export", run, "--output = '': expected what to write");
  ExpectRefused("sf_export", (folder / "none") + output + ".glb",
                "none: expected the directory of a run");
  ExpectRefused("sf_export", folder.Make("empty") + output + ".glb",
                "empty/trajectory.txt");
  ExpectRefused("sf_export", run + output + ".usd",
                "expected a name that ends in .glb, .pc2, .npz or /, or --as");
  ExpectRefused("sf_export", run + output + " --as=usd",
                "--as = 'usd': expected glb, pc2, npz");
  ExpectRefused("sf_export", run + output + ".glb --surfaces=7",
                "surface 7: expected one of 0, 1");
  for (const char* bad : {"x", "1,,2", "1,", "-1", "99999999999"}) {
    ExpectRefused("sf_export", run + output + ".glb --surfaces=" + bad,
                  "expected ids of surfaces, as in 0,2");
  }
  ExpectRefused("sf_export", run + output + ".glb --every=0",
                "--every = 0: expected >= 1");
  ExpectRefused("sf_export", run + output + ".glb --influences=5",
                "--influences = 5: expected 4 or 8");
  ExpectRefused("sf_export", run + output + ".glb --space=moon",
                "--space = 'moon': expected world or camera");
  folder.Write("file", "");
  for (const char* kind : {"glb", "pc2", "npz", "tum", "kitti", "ply"}) {
    ExpectRefused("sf_export",
                  run + " --output=" + (folder / "file/x") + " --as=" + kind,
                  folder / "file/x");
  }
  EXPECT_FALSE(folder.Has("out.glb"));
}

TEST_F(SfExport, BlenderShowsItWhereTheRunHasIt) {
  if (std::system("command -v blender >/dev/null") != 0) {
    GTEST_SKIP() << "blender not found: install Debian's package";
  }
  const fs::path script = RepositoryRoot() / "tests/blender_check.py";
  if (!fs::exists(script)) GTEST_SKIP() << "not built in the repository";
  ASSERT_EQ(Export("scene.glb", "--surfaces=1").exit_code, 0);
  ASSERT_EQ(Export("scene.pc2", "--surfaces=1").exit_code, 0);
  const std::string command = "blender --background --python " +
                              script.string() + " -- " + (folder_ / "run") +
                              " --glb=" + (folder_ / "scene.glb") +
                              " --pc2=" + (folder_ / "scene_001_person.pc2") +
                              " >" + (folder_ / "blender.txt") + " 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << folder_.Read("blender.txt");
  EXPECT_THAT(folder_.Read("blender.txt"),
              HasSubstr("001_person: at most 0.0"));
}

}  // namespace
}  // namespace splitfusion
