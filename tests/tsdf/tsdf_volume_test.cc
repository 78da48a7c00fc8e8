// Rigid fusion, meshing and files.

#include "splitfusion/lib/tsdf/tsdf_volume.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "support/expect_input_error.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

constexpr double kVoxel = 0.01;
const TsdfOptions kOptions = {kVoxel, 0.04, 64};

void Fuse(const cv::Mat_<float>& depth, const Rigid3d& camera_from_canonical,
          TsdfVolume* volume) {
  const DepthObservation observation = ObserveAll(SmallCamera(), depth);
  AllocateBand(observation, camera_from_canonical, volume);
  IntegrateRigid(observation, camera_from_canonical, volume);
}

TriangleMesh FusedMesh(const cv::Mat_<float>& depth) {
  TsdfVolume volume(kOptions);
  Fuse(depth, Rigid3d::Identity(), &volume);
  return ExtractMesh(volume, 0.5);
}

double MeanDepth(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) sum += v.z();
  return sum / static_cast<double>(mesh.vertices.size());
}

void ExpectOutwardAndCounterClockwise(const TriangleMesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  int wrong = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f face =
        (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    wrong += face.dot(mesh.normals[t[0]]) < 0;
    EXPECT_LT(mesh.normals[t[0]].dot(a), 0) << "not towards the camera";
  }
  // Slivers may be turned either way.
  EXPECT_LT(wrong, 0.002 * mesh.triangles.size());
}

TEST(TsdfVolume, APlaneIsFusedToAFractionOfAVoxel) {
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const TriangleMesh mesh = FusedMesh(PlaneDepth(SmallCamera(), n, 1.1));
  ASSERT_GT(mesh.vertices.size(), 5000u);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LT(std::abs(n.dot(mesh.vertices[i].cast<double>()) - 1.1),
              0.3 * kVoxel);
    EXPECT_GT(-n.dot(mesh.normals[i].cast<double>()), 0.95);
  }
  ExpectOutwardAndCounterClockwise(mesh);
}

TEST(TsdfVolume, ASphereIsFusedToAFractionOfAVoxel) {
  const Eigen::Vector3d center(0.05, -0.02, 1.1);
  const TriangleMesh mesh = FusedMesh(SphereDepth(SmallCamera(), center, 0.3));
  double sum = 0;
  int count = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Eigen::Vector3d p = v.cast<double>();
    // Seen under less than 60 degrees; a projective distance is longer than
    // the true one elsewhere.
    if ((center - p).dot(p) < 0.5 * 0.3 * p.norm()) continue;
    sum += std::abs((p - center).norm() - 0.3);
    ++count;
  }
  EXPECT_GT(count, 2000);
  EXPECT_LT(sum / count, 0.2 * kVoxel);
  ExpectOutwardAndCounterClockwise(mesh);
}

TEST(TsdfVolume, ColoursAreThoseOfTheImage) {
  const TriangleMesh mesh = FusedMesh(WallDepth(SmallCamera(), 1.1));
  ASSERT_FALSE(mesh.colors.empty());
  for (const auto& color : mesh.colors) {
    EXPECT_GE(color[0], 250);  // ObserveAll is red.
    EXPECT_LE(color[1], 5);
    EXPECT_LE(color[2], 5);
  }
}

TEST(TsdfVolume, ViewsFromTwoPlacesMeetInTheCanonicalFrame) {
  // The plane n . x = d of the canonical frame, seen by a moved camera.
  const Eigen::Vector3d n(0, 0, 1);
  const Rigid3d motion = MakeMotion({0.1, 0.2, 0.05}, {0.1, -0.05, 0.1});
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  const Eigen::Vector3d moved = motion.linear() * n;
  Fuse(PlaneDepth(SmallCamera(), moved, 1.1 + moved.dot(motion.translation())),
       motion, &volume);
  const TriangleMesh mesh = ExtractMesh(volume, 0.5);
  ASSERT_GT(mesh.vertices.size(), 8000u);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_NEAR(v.z(), 1.1, 0.3 * kVoxel);
  }
}

TEST(TsdfVolume, IsARunningMean) {
  TsdfVolume volume(kOptions);
  for (const double z : {1.09, 1.10, 1.11}) {
    Fuse(WallDepth(SmallCamera(), z), Rigid3d::Identity(), &volume);
  }
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.10, 0.1 * kVoxel);
}

TEST(TsdfVolume, WeightsOfThePixelsCount) {
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.10), Rigid3d::Identity(), &volume);
  DepthObservation strong =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.12));
  strong.weight.setTo(3);
  IntegrateRigid(strong, Rigid3d::Identity(), &volume);
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.115, 0.1 * kVoxel);
  DepthObservation weightless =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.08));
  weightless.weight.setTo(0);
  IntegrateRigid(weightless, Rigid3d::Identity(), &volume);
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.115, 0.1 * kVoxel);
}

TEST(TsdfVolume, TheWeightCapKeepsTheModelYoung) {
  const auto mean_after_change = [](double max_weight) {
    TsdfVolume volume({kVoxel, 0.04, max_weight});
    for (int i = 0; i < 20; ++i) {
      Fuse(WallDepth(SmallCamera(), 1.10), Rigid3d::Identity(), &volume);
    }
    for (int i = 0; i < 4; ++i) {
      Fuse(WallDepth(SmallCamera(), 1.12), Rigid3d::Identity(), &volume);
    }
    return MeanDepth(ExtractMesh(volume, 0.5));
  };
  // Weight 4 blends by 1/5: what stays of the old is (4/5)^4.
  EXPECT_NEAR(mean_after_change(4), 1.12 - 0.02 * std::pow(0.8, 4),
              0.1 * kVoxel);
  EXPECT_NEAR(mean_after_change(1000), 1.10 + 0.02 * 4 / 24, 0.1 * kVoxel);
}

TEST(TsdfVolume, WhatMovedAwayIsCarved) {
  cv::Mat_<float> with_box = WallDepth(SmallCamera(), 1.3);
  with_box(cv::Rect(60, 40, 40, 40)).setTo(0.9f);
  TsdfVolume volume(kOptions);
  Fuse(with_box, Rigid3d::Identity(), &volume);
  const auto near_vertices = [&] {
    int count = 0;
    for (const Eigen::Vector3f& v : ExtractMesh(volume, 0.5).vertices) {
      count += v.z() < 1.0f;
    }
    return count;
  };
  EXPECT_GT(near_vertices(), 500);
  for (int i = 0; i < 3; ++i) {
    Fuse(WallDepth(SmallCamera(), 1.3), Rigid3d::Identity(), &volume);
  }
  EXPECT_EQ(near_vertices(), 0);
}

TEST(TsdfVolume, PixelsOfOtherSurfacesCarveButDoNotWrite) {
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  DepthObservation other =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.12));
  other.role.setTo(static_cast<int>(PixelRole::kCarve));
  IntegrateRigid(other, Rigid3d::Identity(), &volume);
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.1, 0.1 * kVoxel);
  // Something in front says nothing about what it hides.
  other.depth = WallDepth(SmallCamera(), 0.7);
  IntegrateRigid(other, Rigid3d::Identity(), &volume);
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.1, 0.1 * kVoxel);
  other.depth = WallDepth(SmallCamera(), 2);
  other.role.setTo(static_cast<int>(PixelRole::kNone));
  for (int i = 0; i < 3; ++i) {
    IntegrateRigid(other, Rigid3d::Identity(), &volume);
  }
  EXPECT_NEAR(MeanDepth(ExtractMesh(volume, 0.5)), 1.1, 0.1 * kVoxel);
  other.role.setTo(static_cast<int>(PixelRole::kCarve));
  for (int i = 0; i < 3; ++i) {
    IntegrateRigid(other, Rigid3d::Identity(), &volume);
  }
  EXPECT_TRUE(ExtractMesh(volume, 0.5).empty());
}

TEST(TsdfVolume, WhatTurnsOutToBeAnotherSurfaceIsForgotten) {
  const auto vertices_after = [](int fused, int refuted, double depth) {
    TsdfVolume volume(kOptions);
    for (int i = 0; i < fused; ++i) {
      Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
    }
    DepthObservation other =
        ObserveAll(SmallCamera(), WallDepth(SmallCamera(), depth));
    other.role.setTo(static_cast<int>(PixelRole::kCarve));
    other.others_refute = true;
    for (int i = 0; i < refuted; ++i) {
      IntegrateRigid(other, Rigid3d::Identity(), &volume);
    }
    return ExtractMesh(volume, 0.5).vertices.size();
  };
  const std::size_t wall = vertices_after(2, 0, 1.1);
  ASSERT_GT(wall, 1000u);
  EXPECT_EQ(vertices_after(2, 2, 1.1), 0u) << "as many frames as it was seen";
  EXPECT_EQ(vertices_after(2, 2, 1.12), 0u);
  EXPECT_EQ(vertices_after(20, 5, 1.1), wall) << "what was seen long stays";
  EXPECT_EQ(vertices_after(2, 9, 1.0), wall) << "hidden, not refuted";
}

TEST(TsdfVolume, WhatIsForgottenInPlacesCanBeMeshed) {
  // Here and there, so that blocks keep or lose all that is inside.
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  DepthObservation other =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.1));
  other.others_refute = true;
  for (int v = 0; v < other.role.rows; ++v) {
    for (int u = 0; u < other.role.cols; ++u) {
      other.role(v, u) = static_cast<std::uint8_t>(
          (u / 7 + v / 5) % 3 == 0 ? PixelRole::kNone : PixelRole::kCarve);
    }
  }
  const std::size_t before = ExtractMesh(volume, 0.05).vertices.size();
  IntegrateRigid(other, Rigid3d::Identity(), &volume);
  const TriangleMesh mesh = ExtractMesh(volume, 0.05);
  EXPECT_GT(mesh.vertices.size(), before / 10);
  EXPECT_LT(mesh.vertices.size(), before / 2);
  EXPECT_NEAR(MeanDepth(mesh), 1.1, 0.1 * kVoxel);
}

TEST(TsdfVolume, MeshesOnlyWhatWasObservedEnough) {
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  EXPECT_FALSE(ExtractMesh(volume, 1).empty());
  EXPECT_TRUE(ExtractMesh(volume, 1.5).empty());
  EXPECT_TRUE(ExtractMesh(TsdfVolume(kOptions), 0).empty());
}

TEST(TsdfVolume, AllocatesOnlyAroundTheSurface) {
  TsdfVolume volume(kOptions);
  DepthObservation nothing =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 0));
  AllocateBand(nothing, Rigid3d::Identity(), &volume);
  EXPECT_EQ(volume.leaf_count(), 0u);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  const std::size_t band = volume.leaf_count();
  // 1.35 x 1.0 m in blocks of 8 cm, two or three deep.
  EXPECT_GT(band, 17u * 12u);
  EXPECT_LT(band, 19u * 15u * 3u);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  EXPECT_EQ(volume.leaf_count(), band);
}

TEST(TsdfVolume, AllocatesAroundPoints) {
  TsdfVolume volume(kOptions);
  AllocateAround({{0.04, 0.04, 0.04}}, 0.01, &volume);
  EXPECT_EQ(volume.leaf_count(), 1u);  // Well inside of one block of 8 cm.
  AllocateAround({{0.04, 0.04, 0.079}}, 0.01, &volume);
  EXPECT_EQ(volume.leaf_count(), 2u);
  AllocateAround({{-0.04, -0.04, -0.04}}, 0.01, &volume);
  EXPECT_EQ(volume.leaf_count(), 3u);
}

TEST(TsdfVolume, FilesRoundTrip) {
  const TemporaryFolder folder;
  TsdfVolume volume({0.012, 0.05, 32});
  const DepthObservation observation =
      ObserveAll(SmallCamera(), SphereDepth(SmallCamera(), {0, 0, 1}, 0.3));
  AllocateBand(observation, Rigid3d::Identity(), &volume);
  IntegrateRigid(observation, Rigid3d::Identity(), &volume);
  volume.Write(folder / "a/tsdf.vdb");
  const TsdfVolume read = TsdfVolume::Read(folder / "a/tsdf.vdb");
  EXPECT_NEAR(read.options().voxel_size, 0.012, 1e-9);
  EXPECT_EQ(read.options().truncation, 0.05);
  EXPECT_EQ(read.options().max_weight, 32);
  EXPECT_EQ(read.leaf_count(), volume.leaf_count());
  const TriangleMesh a = ExtractMesh(volume, 0.5);
  const TriangleMesh b = ExtractMesh(read, 0.5);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.colors, b.colors);
}

std::string StateOf(const TsdfVolume& volume) {
  std::ostringstream out;
  ArchiveWriter archive(&out);
  archive(volume);
  archive.Flush();
  return out.str();
}

void Restore(const std::string& state, TsdfVolume* volume) {
  std::istringstream in(state);
  ArchiveReader archive(&in, state.size(), "state");
  archive(*volume);
  EXPECT_EQ(archive.left(), 0u);
}

TEST(TsdfVolume, GoesOnFromItsStateBitForBit) {
  for (const bool has_color : {true, false}) {
    TsdfOptions options = kOptions;
    options.has_color = has_color;
    TsdfVolume volume(options), restored(options);
    Fuse(SphereDepth(SmallCamera(), {0, 0, 1}, 0.3), Rigid3d::Identity(),
         &volume);
    AllocateAround({{1, 1, 1}}, 0.1, &volume);  // Never observed.
    Fuse(WallDepth(SmallCamera(), 1), Rigid3d::Identity(), &restored);
    Restore(StateOf(volume), &restored);
    EXPECT_EQ(restored.leaf_count(), volume.leaf_count());
    for (TsdfVolume* each : {&volume, &restored}) {
      Fuse(SphereDepth(SmallCamera(), {0.1, 0, 1}, 0.2), Rigid3d::Identity(),
           each);
    }
    EXPECT_TRUE(StateOf(restored) == StateOf(volume));
    const TriangleMesh a = ExtractMesh(volume, 0.5);
    const TriangleMesh b = ExtractMesh(restored, 0.5);
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.colors, b.colors);
  }
}

TEST(TsdfVolume, RefusesTheStateOfOtherVoxels) {
  const std::string state = StateOf(TsdfVolume({0.012, 0.05, 32}));
  TsdfVolume volume(kOptions);
  ExpectInputError([&] { Restore(state, &volume); },
                   "state: section 'volume': voxel_size = 0.012");
}

TEST(TsdfVolume, WithoutColourTheShapeIsTheSame) {
  TsdfOptions options = kOptions;
  options.has_color = false;
  TsdfVolume volume(options);
  const cv::Mat_<float> depth = WallDepth(SmallCamera(), 1);
  DepthObservation observation = ObserveAll(SmallCamera(), depth);
  observation.color.release();
  AllocateBand(observation, Rigid3d::Identity(), &volume);
  IntegrateRigid(observation, Rigid3d::Identity(), &volume);
  const TriangleMesh mesh = ExtractMesh(volume, 0.5);
  const TriangleMesh colored = FusedMesh(depth);
  EXPECT_EQ(mesh.vertices, colored.vertices);
  EXPECT_EQ(mesh.triangles, colored.triangles);
  const std::array<std::uint8_t, 3> black = {0, 0, 0};
  EXPECT_EQ(mesh.colors.front(), black);
  EXPECT_NE(colored.colors.front(), black);

  const TemporaryFolder folder;
  const std::string path = folder / "volume.vdb";
  volume.Write(path);
  const TsdfVolume read = TsdfVolume::Read(path);
  EXPECT_FALSE(read.options().has_color);
  EXPECT_EQ(ExtractMesh(read, 0.5).vertices, mesh.vertices);
}

TEST(TsdfVolume, BadFilesAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path) {
    ExpectInputError([&] { TsdfVolume::Read(path); }, path);
  };
  refused(folder / "missing.vdb");
  refused(folder.Write("empty.vdb", ""));
  refused(folder.Write("text.vdb", "this is no volume, is it?"));
  TsdfVolume volume(kOptions);
  Fuse(WallDepth(SmallCamera(), 1.1), Rigid3d::Identity(), &volume);
  volume.Write(folder / "whole.vdb");
  const std::string bytes = folder.Read("whole.vdb");
  for (const double part : {0.02, 0.3, 0.9}) {
    refused(folder.Write("cut.vdb", bytes.substr(0, part * bytes.size())));
  }
  folder.Write("file", "");
  ExpectInputError([&] { volume.Write(folder / "file/tsdf.vdb"); },
                   folder / "file/tsdf.vdb");
}

TEST(TsdfOptions, RefuseValuesOutOfRange) {
  ExpectInputError(
      [] {
        TsdfVolume({0, 0.04, 64});
      },
      "voxel = 0: expected 0.001..1 metres, not 1");
  ExpectInputError(
      [] {
        TsdfVolume({0.01, 0.015, 64});
      },
      "truncation = 0.015: expected 2 to 50 voxels (0.02");
  ExpectInputError(
      [] {
        TsdfVolume({0.01, 0.04, 0});
      },
      "max_weight = 0: expected >= 1");
}

}  // namespace
}  // namespace splitfusion
