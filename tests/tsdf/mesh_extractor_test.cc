// Meshing block by block against OpenVDB's mesher of whole volumes.

#include "splitfusion/lib/tsdf/mesh_extractor.h"

#include <gtest/gtest.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

const TsdfOptions kMeshOptions = {0.01, 0.03, 12};
constexpr double kMinWeight = 0.5;

/// A ball that rolls past, in front of a wall, seen by a moving camera.
void FuseFrame(int frame, TsdfVolume* volume) {
  const PinholeCamera camera = SmallCamera();
  cv::Mat_<float> depth = WallDepth(camera, 1.2);
  const cv::Mat_<float> ball =
      SphereDepth(camera, {0.04 * frame - 0.1, 0.02, 0.9}, 0.12);
  ball.copyTo(depth, ball > 0);
  DepthObservation observation = ObserveAll(camera, depth);
  observation.color.setTo(cv::Scalar(20 * frame, 100, 200));
  const Rigid3d motion = MakeMotion({0, 0.01 * frame, 0}, {0, 0, 0});
  AllocateBand(observation, motion, volume);
  IntegrateRigid(observation, motion, volume);
}

void ExpectSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// Observed part of OpenVDB's mesh: vertices and triangles.
TriangleMesh MeshByOpenVdb(const TsdfVolume& volume) {
  openvdb::tools::VolumeToMesh mesher(0.0);
  mesher(*volume.grids().distance);
  const auto weight = volume.grids().weight->getConstAccessor();
  TriangleMesh mesh;
  std::vector<int> kept(mesher.pointListSize(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const openvdb::Vec3s& p = mesher.pointList()[i];
    const openvdb::Coord low = openvdb::Coord::floor(
        volume.grids().distance->transform().worldToIndex(p));
    bool observed = true;
    for (int corner = 0; corner < 8; ++corner) {
      observed &= weight.getValue(low.offsetBy(corner & 1, (corner >> 1) & 1,
                                               corner >> 2)) >=
                  static_cast<float>(kMinWeight);
    }
    if (!observed) continue;
    kept[i] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(p[0], p[1], p[2]);
  }
  for (std::size_t n = 0; n < mesher.polygonPoolListSize(); ++n) {
    const openvdb::tools::PolygonPool& pool = mesher.polygonPoolList()[n];
    for (std::size_t i = 0; i < pool.numQuads(); ++i) {
      const openvdb::Vec4I& q = pool.quad(i);
      for (const auto& [b, c] : {std::pair(1, 2), {2, 3}}) {
        const Eigen::Vector3i t(kept[q[0]], kept[q[b]], kept[q[c]]);
        if (t.minCoeff() >= 0) mesh.triangles.push_back(t);
      }
    }
  }
  return mesh;
}

TEST(MeshExtractor, IsOpenVdbsMesh) {
  TsdfVolume volume(kMeshOptions);
  for (int frame = 0; frame < 5; ++frame) FuseFrame(frame, &volume);
  const TriangleMesh expected = MeshByOpenVdb(volume);
  const TriangleMesh mesh = ExtractMesh(volume, kMinWeight);
  ASSERT_GT(mesh.triangles.size(), 10000u);
  EXPECT_EQ(mesh.vertices, expected.vertices);
  EXPECT_EQ(mesh.triangles, expected.triangles);
}

TEST(MeshExtractor, ChangesAreMeshedAsIfAllWereMeshedAnew) {
  TsdfVolume volume(kMeshOptions);
  MeshExtractor extractor;
  for (int frame = 0; frame < 8; ++frame) {
    FuseFrame(frame, &volume);
    if (frame == 3) continue;  // Two integrations between meshes.
    ExpectSame(extractor.Extract(volume, kMinWeight),
               ExtractMesh(volume, kMinWeight));
  }
}

TEST(MeshExtractor, RefusesWeightsWhoseChangesItIsNotTold) {
  TsdfVolume volume(kMeshOptions);
  FuseFrame(0, &volume);
  MeshExtractor extractor;
  const double above = MeshExtractor::kMaxMinWeight + 1;
  extractor.Extract(volume, above);  // All is new.
  EXPECT_THROW(extractor.Extract(volume, above), InputError);
}

TEST(MeshExtractor, VoxelsThatGetTheLargestMinWeightAreMeshed) {
  // Nothing but weights changes: the same frame again and again.
  TsdfVolume volume(kMeshOptions);
  MeshExtractor extractor;
  std::size_t vertices = 0;
  for (int i = 0; i < 10; ++i) {
    FuseFrame(0, &volume);
    const TriangleMesh mesh =
        extractor.Extract(volume, MeshExtractor::kMaxMinWeight);
    ExpectSame(mesh, ExtractMesh(volume, MeshExtractor::kMaxMinWeight));
    vertices = mesh.vertices.size();
  }
  EXPECT_GT(vertices, 5000u);
}

TEST(MeshExtractor, TellsWhichVerticesAreUntouched) {
  TsdfVolume volume(kMeshOptions);
  MeshExtractor extractor;
  FuseFrame(0, &volume);
  const TriangleMesh before = extractor.Extract(volume, kMinWeight);
  for (const int from : extractor.kept_from()) EXPECT_EQ(from, -1);
  // Only the left half of the image is seen again.
  DepthObservation half =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.21));
  half.role.colRange(80, 160).setTo(static_cast<int>(PixelRole::kNone));
  IntegrateRigid(half, Rigid3d::Identity(), &volume);
  const TriangleMesh after = extractor.Extract(volume, kMinWeight);
  ASSERT_EQ(extractor.kept_from().size(), after.vertices.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < after.vertices.size(); ++i) {
    const int from = extractor.kept_from()[i];
    if (from < 0) continue;
    ++kept;
    EXPECT_EQ(after.vertices[i], before.vertices[from]);
    EXPECT_EQ(after.normals[i], before.normals[from]);
  }
  EXPECT_GT(kept, after.vertices.size() / 3);
  EXPECT_LT(kept, 2 * after.vertices.size() / 3);
  // Without a change all of it is kept.
  ExpectSame(extractor.Extract(volume, kMinWeight), after);
  for (std::size_t i = 0; i < after.vertices.size(); ++i) {
    EXPECT_EQ(extractor.kept_from()[i], static_cast<int>(i));
  }
}

TEST(MeshExtractor, DoesNotDependOnTheNumberOfThreads) {
  TsdfVolume volume(kMeshOptions);
  FuseFrame(2, &volume);
  const TriangleMesh parallel = ExtractMesh(volume, kMinWeight);
  const tbb::global_control one_thread(
      tbb::global_control::max_allowed_parallelism, 1);
  ExpectSame(ExtractMesh(volume, kMinWeight), parallel);
}

}  // namespace
}  // namespace splitfusion
