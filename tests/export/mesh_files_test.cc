// Meshes, point caches and arrays for other programs.

#include "splitfusion/lib/export/mesh_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "splitfusion/lib/export/npz_file.h"
#include "splitfusion/lib/export/point_cache.h"
#include "support/expect_input_error.h"
#include "support/joined_run.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

template <typename T>
T ValueIn(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

TriangleMesh OneTriangle() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 1}, {0.5f, 0, 1}, {0, -0.25f, 1}};
  mesh.normals = {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}};
  mesh.colors = {{255, 0, 51}, {0, 0, 0}, {1, 2, 3}};
  mesh.triangles = {{0, 2, 1}};
  return mesh;
}

TEST(WriteObj, HasColoursBehindPlacesAndCountsFromOne) {
  const TemporaryFolder folder;
  TriangleMesh mesh = OneTriangle();
  WriteObj(folder / "a.obj", mesh);
  EXPECT_EQ(folder.Read("a.obj"),
            "v 0.000000 0.000000 1.000000 1.0000 0.0000 0.2000\n"
            "v 0.500000 0.000000 1.000000 0.0000 0.0000 0.0000\n"
            "v 0.000000 -0.250000 1.000000 0.0039 0.0078 0.0118\n"
            "vn 0.0000 0.0000 -1.0000\nvn 0.0000 0.0000 -1.0000\n"
            "vn 0.0000 0.0000 -1.0000\nf 1//1 3//3 2//2\n");
  mesh.normals.clear();
  mesh.colors.clear();
  WriteObj(folder / "b.obj", mesh);
  EXPECT_THAT(folder.Read("b.obj"),
              HasSubstr("v 0.500000 0.000000 1.000000\n"));
  EXPECT_THAT(folder.Read("b.obj"), HasSubstr("\nf 1 3 2\n"));
}

TEST(WritePcd, HasFieldsAsPclPacksThem) {
  const TemporaryFolder folder;
  WritePcd(folder / "a.pcd", OneTriangle());
  const std::string file = folder.Read("a.pcd");
  EXPECT_THAT(file, HasSubstr("\nFIELDS x y z normal_x normal_y normal_z rgb\n"
                              "SIZE 4 4 4 4 4 4 4\nTYPE F F F F F F U\n"));
  EXPECT_THAT(file, HasSubstr("\nPOINTS 3\nDATA binary\n"));
  const std::size_t begin = file.find("binary\n") + 7;
  ASSERT_EQ(file.size(), begin + 3 * 28);
  EXPECT_EQ(ValueIn<float>(file, begin + 28), 0.5f);
  EXPECT_EQ(ValueIn<float>(file, begin + 20), -1.0f);
  EXPECT_EQ(ValueIn<std::uint32_t>(file, begin + 24), 0xFF0033u);
}

TEST(WritePointCaches, HaveEveryFrameFromFirstToLast) {
  const TemporaryFolder folder;
  JoinedRun().Write(folder / "run");
  ExportOptions options;
  options.y_up = true;
  options.refuted = false;
  const ExportScene scene = ReadExportScene(folder / "run", options);
  const auto files = WritePointCaches(folder / "x", scene);
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[0].mesh, folder / "x_000_background.obj");
  EXPECT_EQ(files[0].cache, "") << "it stands still";
  EXPECT_FALSE(folder.Has("x_000_background.pc2"));
  EXPECT_EQ(files[2].cache, folder / "x_001_thin_plate_2.pc2");
  EXPECT_EQ(files[2].start, 6u);
  EXPECT_EQ(files[2].frames, 6u);
  EXPECT_TRUE(folder.Has("x_002_ball.pc2"));
  const std::string file = folder.Read("x_001_thin_plate_2.pc2");
  EXPECT_EQ(file.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(ValueIn<std::int32_t>(file, 12), 1);
  const ExportSurface& surface = scene.surfaces[2];
  const std::size_t count = surface.mesh.vertices.size();
  EXPECT_EQ(ValueIn<std::int32_t>(file, 16), static_cast<int>(count));
  EXPECT_EQ(ValueIn<float>(file, 20), 6.0f);
  EXPECT_EQ(ValueIn<float>(file, 24), 1.0f);
  EXPECT_EQ(ValueIn<std::int32_t>(file, 28), 6);
  ASSERT_EQ(file.size(), 32 + 6 * count * 12);
  // It is not there in frame 8, and stays as in frame 7.
  const std::vector<int> moments = {0, 1, 1, 2, 3, 4};
  for (std::size_t sample = 0; sample < moments.size(); ++sample) {
    const auto vertices = surface.At(surface.moments[moments[sample]]).vertices;
    EXPECT_EQ(std::memcmp(vertices.data(),
                          file.data() + 32 + sample * count * 12, count * 12),
              0)
        << sample;
  }
}

TEST(WritePointCaches, LeaveOutWhatNoTriangleUses) {
  const TemporaryFolder folder;
  JoinedRun().Write(folder / "run");
  ExportScene scene = ReadExportScene(folder / "run", {});
  ExportSurface& surface = scene.surfaces.at(1);
  const std::size_t count = surface.mesh.vertices.size();
  std::vector<Eigen::Vector3i>& triangles = surface.mesh.triangles;
  triangles = {{4, 2, 5}};
  ASSERT_GT(count, 6u);
  ExportSurface used = surface;
  LeaveUnusedOut(&used);
  EXPECT_EQ(used.source, (std::vector<int>{surface.source[2], surface.source[4],
                                           surface.source[5]}));
  EXPECT_EQ(used.mesh.triangles[0], Eigen::Vector3i(1, 0, 2));
  EXPECT_EQ(used.skinning.size(), 3u);
  EXPECT_EQ(used.mesh.colors.size(), surface.mesh.colors.empty() ? 0u : 3u);
  const auto files = WritePointCaches(folder / "x", scene);
  const std::string cache = folder.Read("x_" + surface.name + ".pc2");
  EXPECT_EQ(ValueIn<std::int32_t>(cache, 16), 3);
  const std::vector<Eigen::Vector3f> all =
      surface.At(surface.moments[0]).vertices;
  EXPECT_EQ(ValueIn<float>(cache, 32), all[2].x());
  EXPECT_EQ(ValueIn<float>(cache, 32 + 12), all[4].x());
  EXPECT_THAT(folder.Read("x_" + surface.name + ".obj"),
              ContainsRegex("\nf 2[^ ]* 1[^ ]* 3[^ ]*\n$"));
  triangles.clear();
  EXPECT_EQ(WritePointCaches(folder / "y", scene).size(), files.size() - 1);
}

TEST(WriteNpz, IsAZipOfArraysAndTheSameTwice) {
  const TemporaryFolder folder;
  const auto fill = [](NpzArrays* arrays) {
    arrays->Add("a/b", {2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6});
    arrays->Add("c", {1}, std::vector<std::uint8_t>{7});
  };
  WriteNpz(folder / "a.npz", fill);
  WriteNpz(folder / "b.npz", fill);
  const std::string file = folder.Read("a.npz");
  EXPECT_EQ(file, folder.Read("b.npz"));
  EXPECT_EQ(file.substr(0, 4), "PK\x03\x04");
  EXPECT_THAT(file, HasSubstr("a/b.npy"));
  const std::size_t begin = file.find("\x93NUMPY");
  ASSERT_NE(begin, std::string::npos);
  const auto size = ValueIn<std::uint16_t>(file, begin + 8);
  EXPECT_EQ((size + 10) % 64, 0);
  EXPECT_THAT(file.substr(begin, size),
              HasSubstr("{'descr': '<f4', 'fortran_order': False, "
                        "'shape': (2, 3, ), }"));
  EXPECT_EQ(ValueIn<float>(file, begin + 10 + size + 8), 3.0f);
  ExpectInputError([&] { WriteNpz(folder / "none/of/these.npz", fill); },
                   "these.npz: cannot be written");
}

}  // namespace
}  // namespace splitfusion
