#include "splitfusion/lib/geometry/triangle_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TriangleMesh Tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1f, 0.2f, 1 / 3.0f}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.normals = ComputeVertexNormals(mesh);
  mesh.colors = {{0, 1, 2}, {255, 254, 253}, {10, 20, 30}, {7, 7, 7}};
  return mesh;
}

std::string ReadMessage(const std::string& path) {
  try {
    ReadPly(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(Ply, RoundTripIsExact) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = Tetrahedron();
  WritePly(folder / "new/mesh.ply", mesh);
  const TriangleMesh read = ReadPly(folder / "new/mesh.ply");
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.normals, mesh.normals);
  EXPECT_EQ(read.colors, mesh.colors);
  EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST(Ply, EmptyMeshAndBareVerticesAreFine) {
  const TemporaryFolder folder;
  WritePly(folder / "empty.ply", {});
  EXPECT_TRUE(ReadPly(folder / "empty.ply").empty());
  TriangleMesh points;
  points.vertices = {{1, 2, 3}};
  WritePly(folder / "points.ply", points);
  const TriangleMesh read = ReadPly(folder / "points.ply");
  EXPECT_EQ(read.vertices, points.vertices);
  EXPECT_TRUE(read.normals.empty());
  EXPECT_TRUE(read.triangles.empty());
}

TEST(Ply, ReadsAsciiPolygonsAndExtraProperties) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(
      "a.ply",
      "ply\r\nformat ascii 1.0\r\ncomment a quad\r\nelement vertex 4\r\n"
      "property float x\r\nproperty float y\r\nproperty float z\r\n"
      "property uchar seen\r\nelement face 1\r\n"
      "property list uchar int vertex_indices\r\nend_header\r\n"
      "0 0 0 3\r\n1 0 0 4\r\n1 1 0 5\r\n0 1 0 6\r\n4 0 1 2 3\r\n");
  PlyProperties extra;
  const TriangleMesh mesh = ReadPly(path, &extra);
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0));
  EXPECT_THAT(mesh.triangles,
              ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)));
  EXPECT_THAT(extra["seen"], ElementsAre(3, 4, 5, 6));
}

TEST(Ply, BadFilesAreRejectedInOneLine) {
  const TemporaryFolder folder;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n";
  const std::string xyz =
      "property float x\nproperty float y\nproperty float z\n";
  const std::string face =
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "first line is not 'ply'"},
      {"solid\n", "first line is not 'ply'"},
      {head + xyz, "no 'end_header'"},
      {"ply\nformat ascii 1.0\nelement vertex 4000000000\n" + xyz +
           "end_header\n",
       "ends before its last"},
      {"ply\nformat ascii 1.0\nelement vertex -5\n" + xyz + "end_header\n",
       "bad line: 'element vertex -5'"},
      {"ply\nelement vertex many\x1b[2J\n", "'element vertex many\\x1b[2J'"},
      {"ply\nformat binary_big_endian 1.0\nend_header\n", "big-endian"},
      {head + xyz + face + "0 0 0\n1 0 0\n", "ends before its last"},
      {head + xyz + face + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "out of range"},
      {head + xyz + face + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "out of range"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
       "property float128 x\nend_header\n12345678",
       "type 'float128' is unknown"}};
  for (const auto& [text, message] : cases) {
    const std::string path = folder.Write("bad.ply", text);
    EXPECT_THAT(ReadMessage(path), HasSubstr(message));
    EXPECT_THAT(ReadMessage(path), HasSubstr("bad.ply"));
    EXPECT_THAT(ReadMessage(path), Not(HasSubstr("\n")));
  }
  EXPECT_THAT(ReadMessage(folder / "none.ply"), HasSubstr("cannot be opened"));
}

TEST(Ply, TruncatedBinaryIsRejected) {
  const TemporaryFolder folder;
  WritePly(folder / "mesh.ply", Tetrahedron());
  const std::string bytes = folder.Read("mesh.ply");
  folder.Write("mesh.ply", bytes.substr(0, bytes.size() - 2));
  EXPECT_THAT(ReadMessage(folder / "mesh.ply"), HasSubstr("ends before"));
}

TEST(ComputeVertexNormals, PointOutwardsAndAreUnitLength) {
  const TriangleMesh mesh = Tetrahedron();
  const Eigen::Vector3f centre(0.275f, 0.3f, 0.08f);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(mesh.normals[i].norm(), 1, 1e-6);
    EXPECT_GT(mesh.normals[i].dot(mesh.vertices[i] - centre), 0);
  }
}

TEST(ComputeVertexNormals, LooseVertexHasNone) {
  TriangleMesh mesh = Tetrahedron();
  mesh.vertices.push_back({5, 5, 5});
  EXPECT_EQ(ComputeVertexNormals(mesh).back(), Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace splitfusion
