// Rigid fusion of whole volumes.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"
#include "support/expect_input_error.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TsdfOptions CoarseVoxels() {
  TsdfOptions options;
  options.voxel_size = 0.02;
  options.truncation = 0.08;
  return options;
}

/// A camera somewhere near the origin that looks along z, more or less.
Rigid3d RandomPose(std::mt19937* random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Eigen::Vector3d axis(unit(*random), unit(*random), unit(*random));
  Rigid3d pose(Eigen::AngleAxisd(0.4 * unit(*random), axis.normalized()));
  pose.translation() =
      0.3 * Eigen::Vector3d(unit(*random), unit(*random), unit(*random));
  return pose;
}

/// Blocks in view, beside it, behind the wall, around the camera and behind it.
TsdfVolume BlocksAllAround() {
  TsdfVolume volume(CoarseVoxels());
  std::vector<Eigen::Vector3d> points;
  for (double z = -0.6; z < 1.7; z += 0.15) {
    for (double x = -1.2; x < 1.3; x += 0.3) {
      points.emplace_back(x, 0.4 * std::sin(5 * x), z);
    }
  }
  AllocateAround(points, 0.1, &volume);
  return volume;
}

/// IntegrateRigid() that passes nothing over.
void IntegrateEverything(const DepthObservation& seen,
                         const Rigid3d& camera_from_canonical,
                         TsdfVolume* volume) {
  TsdfVolume::Grids& grids = volume->grids();
  ++grids.time;
  const internal::FusionImage image(seen, volume->options(), grids.time);
  const Rigid3f motion = camera_from_canonical.cast<float>();
  const auto voxel = static_cast<float>(volume->options().voxel_size);
  float steps[3][3];
  for (int i = 0; i < 9; ++i) {
    steps[i / 3][i % 3] = voxel * motion.linear()(i % 3, i / 3);
  }
  for (std::size_t i = 0; i < grids.leaves.size(); ++i) {
    const openvdb::Coord origin = grids.leaves[i].origin;
    const Eigen::Vector3f base =
        motion * (voxel * Eigen::Vector3f(static_cast<float>(origin.x()),
                                          static_cast<float>(origin.y()),
                                          static_cast<float>(origin.z())));
    const internal::RigidLeaf leaf = {{base.x(), base.y(), base.z()},
                                      kInfinity,
                                      internal::ToFused(grids.leaves[i])};
    if (internal::FuseRigidLeaf(image.view(), steps, leaf, leaf.leaf)) {
      grids.RecordChange(i, internal::HasInside(leaf.leaf));
    }
  }
}

/// Expects the same voxels and states.
void ExpectSame(const TsdfVolume& a, const TsdfVolume& b) {
  ASSERT_EQ(a.leaf_count(), b.leaf_count());
  for (std::size_t i = 0; i < a.leaf_count(); ++i) {
    const internal::LeafBuffers& x = a.grids().leaves[i];
    const internal::LeafBuffers& y = b.grids().leaves[i];
    for (int k = 0; k < internal::kLeafVoxels; ++k) {
      ASSERT_EQ(x.distance[k], y.distance[k]) << "block " << i;
      ASSERT_EQ(x.weight[k], y.weight[k]) << "block " << i;
      ASSERT_EQ(x.color[k], y.color[k]) << "block " << i;
    }
    const internal::LeafState& s = a.grids().states[i];
    const internal::LeafState& t = b.grids().states[i];
    EXPECT_EQ(s.changed, t.changed) << "block " << i;
    EXPECT_EQ(s.has_inside, t.has_inside) << "block " << i;
  }
}

TEST(IntegrateRigid, WhatIsPassedOverWouldNotHaveChanged) {
  std::mt19937 random(5);
  TsdfVolume volume = BlocksAllAround(), everything = BlocksAllAround();
  // Its tiles and batches of blocks are not all whole.
  PinholeCamera camera = SmallCamera();
  camera.width -= 3;
  camera.height -= 3;
  ASSERT_NE(volume.leaf_count() % 32, 0u);
  std::uniform_int_distribution<int> die(0, 9);
  for (int round = 0; round < 20; ++round) {
    DepthObservation seen =
        ObserveAll(camera, PlaneDepth(camera, {0.3, 0.1, 0.9}, 1.0));
    for (std::uint8_t& role : seen.role) {
      role = static_cast<std::uint8_t>(die(random) < 2 ? PixelRole::kCarve
                                                       : PixelRole::kWrite);
    }
    const Rigid3d pose = RandomPose(&random);
    IntegrateRigid(seen, pose, &volume);
    IntegrateEverything(seen, pose, &everything);
    ExpectSame(volume, everything);
  }
  int changed = 0;
  for (const internal::LeafState& state : volume.grids().states) {
    changed += state.changed > 0;
  }
  EXPECT_GT(changed, 50);
  EXPECT_LT(changed, static_cast<int>(volume.leaf_count()) - 50);
}

/// Mean z-depth of the mesh of a wall at z-depth `depth` after many frames of
/// Gaussian noise, metres; `reach`: TsdfOptions::reach_sigmas.
double NoisyWall(double depth, double reach) {
  std::mt19937 random(3);
  const PinholeCamera camera = SmallCamera();
  TsdfOptions options;
  options.voxel_size = 0.02;
  options.reach_sigmas = reach;
  options.has_color = false;
  TsdfVolume volume(options);
  const auto sigma = static_cast<float>(camera.noise.Sigma(depth));
  std::normal_distribution<float> noise(0, sigma);
  for (int frame = 0; frame < 20; ++frame) {
    DepthObservation seen = ObserveAll(camera, WallDepth(camera, depth));
    for (float& d : seen.depth) d += noise(random);
    AllocateBand(seen, Rigid3d::Identity(), &volume);
    IntegrateRigid(seen, Rigid3d::Identity(), &volume);
  }
  const TriangleMesh mesh = ExtractMesh(volume, 8);
  double sum = 0;
  for (const Eigen::Vector3f& p : mesh.vertices) sum += p.z();
  return sum / static_cast<double>(mesh.vertices.size());
}

TEST(IntegrateRigid, NoiseBeyondTheTruncationMovesNoSurface) {
  for (const double depth : {1.5, 3.5, 4.5}) {
    EXPECT_NEAR(NoisyWall(depth, 3), depth, 0.0005) << depth;
  }
  EXPECT_GT(NoisyWall(4.5, 0), 4.503);  // The noise is 3.3 cm there.
}

TEST(IntegrateRigid, BehindTheCameraNothingChanges) {
  TsdfVolume volume = BlocksAllAround();
  Rigid3d pose = Rigid3d::Identity();
  pose.translation().z() = -5;
  IntegrateRigid(ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1)), pose,
                 &volume);
  for (const internal::LeafState& state : volume.grids().states) {
    EXPECT_LT(state.changed, volume.grids().time);
  }
}

/// Grey of the voxel nearest to the middle of a wall, after many frames.
double GreyAfter(int frames, double confidence, int grey, TsdfVolume* volume) {
  DepthObservation seen =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
  seen.weight.setTo(confidence);
  seen.color.setTo(cv::Scalar::all(grey));
  AllocateBand(seen, Rigid3d::Identity(), volume);
  for (int i = 0; i < frames; ++i) {
    IntegrateRigid(seen, Rigid3d::Identity(), volume);
  }
  const std::int32_t color =
      volume->grids().color->tree().getValue(openvdb::Coord(0, 0, 50));
  return internal::ChannelOf(color, 1) * 255.0 / internal::kChannelEnd;
}

TEST(IntegrateRigid, ColorsFollowSmallChanges) {
  TsdfVolume volume(CoarseVoxels());
  EXPECT_NEAR(GreyAfter(100, 1, 100, &volume), 100, 0.5);
  EXPECT_NEAR(GreyAfter(500, 1, 104, &volume), 104, 1);
  // The running mean of floats: what remains after 500 frames of blend 0.3/64.
  const double remains = std::pow(1 - 0.3 / 64.3, 500);
  EXPECT_NEAR(GreyAfter(500, 0.3, 120, &volume), 120 - 16 * remains, 1.5);
}

TEST(IntegrateRigid, AnotherColorAloneIsAChange) {
  TsdfVolume volume(CoarseVoxels());
  GreyAfter(300, 1, 100, &volume);
  const auto changed = [&] {
    int count = 0;
    for (const internal::LeafState& state : volume.grids().states) {
      count += state.changed == volume.grids().time;
    }
    return count;
  };
  GreyAfter(1, 1, 100, &volume);
  const int still = changed();
  GreyAfter(1, 1, 200, &volume);
  EXPECT_GT(changed(), still);
}

TEST(IntegrateRigid, RefusesWhatIsMissing) {
  TsdfVolume volume(CoarseVoxels());
  DepthObservation seen =
      ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
  seen.role.release();
  ExpectInputError([&] { AllocateBand(seen, Rigid3d::Identity(), &volume); },
                   "role image is 0x0");
  ExpectInputError([&] { IntegrateRigid(seen, Rigid3d::Identity(), &volume); },
                   "role image is 0x0");
  EXPECT_EQ(volume.leaf_count(), 0u);
}

}  // namespace
}  // namespace splitfusion
