// Block-wise fusion against the update written down voxel by voxel.

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "splitfusion/lib/tsdf/internal/packed_color.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr float kVoxel = 0.01f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
const TsdfOptions kFusionOptions = {kVoxel, 0.04, 20, /*reach_sigmas=*/3};

/// A block's voxels.
struct Block {
  std::array<float, 512> distance, weight;
  std::array<std::int32_t, 512> color;

  FusedLeaf leaf() { return {distance.data(), weight.data(), color.data()}; }
  /// Byte by byte.
  bool operator==(const Block& other) const {
    return std::memcmp(distance.data(), other.distance.data(),
                       sizeof(distance)) == 0 &&
           std::memcmp(weight.data(), other.weight.data(), sizeof(weight)) ==
               0 &&
           color == other.color;
  }
};

/// HasInside(), voxel by voxel.
bool IsAnyInside(const Block& block) {
  for (int i = 0; i < 512; ++i) {
    if (block.distance[i] <= 0 && block.weight[i] > 0) return true;
  }
  return false;
}

Block RandomBlock(std::mt19937* random) {
  std::uniform_real_distribution<float> unit(0, 1);
  Block block;
  for (float& d : block.distance) d = 0.08f * unit(*random) - 0.04f;
  for (float& w : block.weight) w = 30 * unit(*random) - 10;
  for (float& w : block.weight) w = std::max(w, 0.0f);  // Unseen: a third.
  std::uniform_int_distribution<int> channel(0, kChannelEnd);
  for (std::int32_t& c : block.color) {
    c = PackColor(channel(*random), channel(*random), channel(*random));
  }
  return block;
}

/// Slanted wall with holes, of pixels of all roles and weights, some so noisy
/// that they reach farther than the truncation.
DepthObservation RandomObservation(std::mt19937* random) {
  PinholeCamera camera = SmallCamera();
  camera.noise.growth = 0.03;
  DepthObservation observation =
      ObserveAll(camera, PlaneDepth(camera, {0.3, 0.1, 0.9}, 1.0));
  std::uniform_int_distribution<int> die(0, 11);
  for (int v = 0; v < observation.depth.rows; ++v) {
    for (int u = 0; u < observation.depth.cols; ++u) {
      const int roll = die(*random);
      observation.role(v, u) = static_cast<std::uint8_t>(
          roll == 0 ? PixelRole::kNone
                    : (roll < 4 ? PixelRole::kCarve : PixelRole::kWrite));
      observation.weight(v, u) = 0.1f * static_cast<float>(roll % 10);
      if (die(*random) == 0) observation.depth(v, u) = 0;
      observation.color.at<cv::Vec3b>(v, u) = cv::Vec3b(roll, 20 * roll, 99);
    }
  }
  return observation;
}

/// Running mean of a colour; `dither`: the voxel's. Sets *is_certain to false
/// if rounding decides.
std::int32_t Blend(std::int32_t before, const cv::Vec3b& bgr, double blend,
                   double dither, bool* is_certain) {
  int mean[3];
  for (int k = 0; k < 3; ++k) {
    const double channel = ChannelOf(before, k);
    const double sample = ChannelFromByte(bgr[2 - k]);
    const double next = channel + blend * (sample - channel) + dither;
    mean[k] = static_cast<int>(std::floor(next));
    if (std::abs(next - std::round(next)) < 1e-3) *is_certain = false;
  }
  return PackColor(mean[0], mean[1], mean[2]);
}

/// Whether a number is so close to a border that rounding decides.
bool IsClose(double value, double border, double margin) {
  return std::abs(value - border) < margin;
}

/// The pixel that a point falls on; false: none. Rounding decides unless it
/// *is_certain.
bool PixelOf(const PinholeCamera& camera, const Eigen::Vector3d& p, int* u,
             int* v, bool* is_certain) {
  constexpr double kMargin = 1e-3;
  const double x = camera.fx * p.x() / p.z() + camera.cx;
  const double y = camera.fy * p.y() / p.z() + camera.cy;
  *u = static_cast<int>(std::floor(x + 0.5));
  *v = static_cast<int>(std::floor(y + 0.5));
  *is_certain = !IsClose(p.z(), 0.05, 1e-5) &&
                !IsClose(x + 0.5, std::round(x + 0.5), kMargin) &&
                !IsClose(y + 0.5, std::round(y + 0.5), kMargin);
  return p.z() > 0.05 && *u >= 0 && *v >= 0 && *u < camera.width &&
         *v < camera.height;
}

/// Kinect Fusion's update of one voxel at `p` of the camera frame. Returns
/// false if rounding decides what becomes of it.
bool UpdateVoxel(const DepthObservation& seen, const float dither[],
                 const Eigen::Vector3d& p, int i, Block* block) {
  constexpr double kMargin = 1e-5;
  const double truncation = kFusionOptions.truncation;
  int u, v;
  bool is_certain;
  if (!PixelOf(seen.camera, p, &u, &v, &is_certain)) return is_certain;
  const auto role = static_cast<PixelRole>(seen.role(v, u));
  const double depth = seen.depth(v, u);
  if (role == PixelRole::kNone || !(depth > 0)) return is_certain;
  const double sdf = depth - p.z();
  const double noise = 3 * seen.camera.noise.Sigma(depth);
  const double free_from = truncation + noise;
  const double behind = std::max(truncation, noise);
  is_certain = is_certain && !IsClose(std::abs(sdf), truncation, kMargin) &&
               !IsClose(sdf, -behind, kMargin) &&
               !IsClose(sdf, free_from, kMargin);
  const bool in_band = role == PixelRole::kWrite && sdf >= -behind;
  if (!in_band && sdf <= truncation) {
    if (seen.others_refute && sdf > -behind) {
      const float rest = block->weight[i] - seen.weight(v, u);
      const bool refuted = seen.weight(v, u) > 0;
      block->weight[i] = std::max(rest, 0.0f);
      if (refuted && rest <= 0) {
        block->distance[i] = static_cast<float>(truncation);
      }
      is_certain = is_certain && !IsClose(rest, 0, kMargin);
    }
    return is_certain;
  }
  const bool empty = sdf > free_from;
  const double confidence = empty ? 1 : seen.weight(v, u);
  const double sum = block->weight[i] + confidence;
  if (!(sum > 0)) return is_certain;
  const double blend = confidence / sum;
  float& distance = block->distance[i];
  distance = static_cast<float>(
      distance + blend * (std::clamp(sdf, -truncation, truncation) - distance));
  if (in_band && sdf < truncation) {
    block->color[i] = Blend(block->color[i], seen.color.at<cv::Vec3b>(v, u),
                            blend, dither[i % 8], &is_certain);
  }
  block->weight[i] =
      static_cast<float>(std::min(sum, kFusionOptions.max_weight));
  return is_certain;
}

/// Expects that voxels agree but for rounding.
void ExpectSameVoxel(const Block& a, const Block& b, int i) {
  EXPECT_NEAR(a.distance[i], b.distance[i], 1e-6) << "voxel " << i;
  EXPECT_NEAR(a.weight[i], b.weight[i], 1e-5) << "voxel " << i;
  EXPECT_EQ(a.color[i], b.color[i]) << "voxel " << i;
}

/// A block somewhere around the wall: its first voxel and steps.
struct Placement {
  Eigen::Vector3f base;
  Eigen::Matrix3f steps;

  Eigen::Vector3d At(int x, int y, int z) const {
    return base.cast<double>() +
           steps.cast<double>() * Eigen::Vector3d(x, y, z);
  }

  /// As a block of which nothing farther away may change.
  RigidLeaf ToRigid(float farthest, Block* block) const {
    return {{base.x(), base.y(), base.z()}, farthest, block->leaf()};
  }

  /// Bounding box of the voxels.
  Eigen::AlignedBox3f Box() const {
    Eigen::AlignedBox3f box;
    for (int i = 0; i < 8; ++i) {
      box.extend(At(7 * (i >> 2), 7 * (i >> 1 & 1), 7 * (i & 1)).cast<float>());
    }
    return box;
  }
};

Placement RandomPlacement(std::mt19937* random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  Placement placement;
  placement.base = {0.9f * unit(*random), 0.7f * unit(*random),
                    1.0f + 1.05f * unit(*random)};
  const Eigen::Vector3f axis(unit(*random), unit(*random), unit(*random));
  placement.steps =
      kVoxel *
      Eigen::AngleAxisf(axis.norm(), axis.normalized()).toRotationMatrix();
  return placement;
}

class VoxelFusion : public ::testing::Test {
 protected:
  std::mt19937 random_{7};
  DepthObservation seen_ = RandomObservation(&random_);
  FusionImage image_{seen_, kFusionOptions, /*time=*/3};
};

/// Steps as FuseRigidLeaf() has them.
struct Steps {
  explicit Steps(const Eigen::Matrix3f& axes) {
    for (int i = 0; i < 9; ++i) rows[i / 3][i % 3] = axes(i % 3, i / 3);
  }
  float rows[3][3];
};

TEST_F(VoxelFusion, ARigidBlockIsUpdatedVoxelByVoxel) {
  int changed_blocks = 0, uncertain = 0;
  seen_.others_refute = true;
  const FusionImage refuting(seen_, kFusionOptions, /*time=*/3);
  for (int round = 0; round < 600; ++round) {
    seen_.others_refute = round >= 300;
    const FusionImage& image = seen_.others_refute ? refuting : image_;
    const Placement at = RandomPlacement(&random_);
    const Steps steps(at.steps);
    const Block before = RandomBlock(&random_);
    Block block = before, expected = before;
    const bool changed = FuseRigidLeaf(
        image.view(), steps.rows, at.ToRigid(kInfinity, &block), block.leaf());
    for (int i = 0; i < 512; ++i) {
      if (UpdateVoxel(seen_, image.view().dither,
                      at.At(i / 64, i / 8 % 8, i % 8), i, &expected)) {
        ExpectSameVoxel(block, expected, i);
      } else {
        ++uncertain;
      }
    }
    EXPECT_TRUE(changed || block.distance == before.distance);
    EXPECT_EQ(HasInside(block.leaf()), IsAnyInside(block));
    changed_blocks += changed;
    // No block that changes may be passed over.
    const float farthest = image.Farthest(at.Box());
    EXPECT_TRUE(at.Box().min().z() < farthest || block == before);
    // Nor any part of one.
    Block bounded = before;
    FuseRigidLeaf(image.view(), steps.rows, at.ToRigid(farthest, &bounded),
                  bounded.leaf());
    EXPECT_TRUE(bounded == block) << "round " << round;
  }
  EXPECT_GT(changed_blocks, 100);
  EXPECT_LT(changed_blocks, 500);
  EXPECT_LT(uncertain, 600 * 512 / 100);
}

TEST_F(VoxelFusion, WithoutColorDistancesAndWeightsAreTheSame) {
  for (int round = 0; round < 40; ++round) {
    const Placement at = RandomPlacement(&random_);
    const Steps steps(at.steps);
    Block colored = RandomBlock(&random_);
    Block plain = colored;
    RigidLeaf without = at.ToRigid(kInfinity, &plain);
    without.leaf.color = nullptr;
    FuseRigidLeaf(image_.view(), steps.rows, at.ToRigid(kInfinity, &colored),
                  colored.leaf());
    FuseRigidLeaf(image_.view(), steps.rows, without, without.leaf);
    plain.color = colored.color;
    EXPECT_TRUE(plain == colored) << "round " << round;
  }
}

TEST_F(VoxelFusion, BoxesAreBoundedByTheFarthestPixelTheyMayMeet) {
  // A wall at 1 m; only the left half of the image writes behind it.
  seen_ = ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
  const int middle = seen_.role.cols / 2;
  seen_.role.colRange(middle, seen_.role.cols)
      .setTo(static_cast<int>(PixelRole::kCarve));
  const FusionImage image(seen_, kFusionOptions, 1);
  const auto farthest = [&](const Eigen::Vector3f& center) {
    const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.02f);
    return image.Farthest({center - half, center + half});
  };
  const auto truncation = static_cast<float>(kFusionOptions.truncation);
  EXPECT_NEAR(farthest({-0.3f, 0, 1}), 1 + truncation, 2e-3);
  EXPECT_NEAR(farthest({0.3f, 0, 1}), 1 - truncation, 2e-3);
  EXPECT_EQ(farthest({0, 0, 0.05f}), kInfinity);  // Around the camera.
  EXPECT_EQ(farthest({0, 0, -0.5f}), -kInfinity);
  EXPECT_EQ(farthest({5, 0, 1}), -kInfinity);
  EXPECT_EQ(farthest({0, -5, 1}), -kInfinity);
}

TEST(HasInside, OneObservedVoxelIsEnough) {
  Block block;
  block.distance.fill(0.01f);
  block.weight.fill(1);
  EXPECT_FALSE(HasInside(block.leaf()));
  for (int i = 0; i < 512; ++i) {
    block.distance[i] = i % 2 == 0 ? 0.0f : -0.01f;
    EXPECT_TRUE(HasInside(block.leaf())) << i;
    block.weight[i] = 0;  // Never observed.
    EXPECT_FALSE(HasInside(block.leaf())) << i;
    block.weight[i] = 1;
    block.distance[i] = 0.01f;
  }
}

/// Where a voxel is between the points of a lattice.
Eigen::Vector3d InLattice(const float lattice[kLatticePoints][3], int x, int y,
                          int z) {
  const auto part = [](int voxel, int end) {
    const double upper = voxel % 4 / 4.0;
    return end == 0 ? 1 - upper : upper;
  };
  Eigen::Vector3d sum(0, 0, 0);
  for (int i = 0; i < 8; ++i) {
    const int dx = i / 4, dy = i / 2 % 2, dz = i % 2;
    const float* point =
        lattice[9 * (x / 4 + dx) + 3 * (y / 4 + dy) + z / 4 + dz];
    sum += part(x, dx) * part(y, dy) * part(z, dz) *
           Eigen::Vector3d(point[0], point[1], point[2]);
  }
  return sum;
}

TEST_F(VoxelFusion, AWarpedBlockIsUpdatedWhereItsLatticeCarriesIt) {
  std::uniform_real_distribution<float> noise(-0.01f, 0.01f);
  for (int round = 0; round < 100; ++round) {
    const Placement at = RandomPlacement(&random_);
    float lattice[kLatticePoints][3];
    for (int i = 0; i < kLatticePoints; ++i) {
      const Eigen::Vector3d p =
          at.At(4 * (i / 9), 4 * (i / 3 % 3), 4 * (i % 3));
      for (int k = 0; k < 3; ++k) {
        lattice[i][k] = static_cast<float>(p[k]) + noise(random_);
      }
    }
    const Block before = RandomBlock(&random_);
    Block block = before, expected = before;
    const bool foreign[kLatticeCells] = {};
    FuseWarpedLeaf(image_.view(), lattice, foreign, block.leaf());
    for (int i = 0; i < 512; ++i) {
      const Eigen::Vector3d p = InLattice(lattice, i / 64, i / 8 % 8, i % 8);
      if (UpdateVoxel(seen_, image_.view().dither, p, i, &expected)) {
        ExpectSameVoxel(block, expected, i);
      }
    }
    Eigen::AlignedBox3f box;
    for (const auto& p : lattice) box.extend(Eigen::Vector3f(p));
    EXPECT_TRUE(box.min().z() < image_.Farthest(box) || block == before);
  }
}

TEST_F(VoxelFusion, IntoForeignCellsOnlyFreeSpaceIsFused) {
  // Blocks before, in and behind a wall at 1 m.
  seen_ = ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
  const FusionImage image(seen_, kFusionOptions, 1);
  const bool foreign[kLatticeCells] = {true, false, false, true,
                                       true, true,  false, false};
  for (const float z : {0.5f, 0.98f, 1.01f}) {
    float lattice[kLatticePoints][3];
    for (int i = 0; i < kLatticePoints; ++i) {
      lattice[i][0] = 4 * kVoxel * static_cast<float>(i / 9);
      lattice[i][1] = 4 * kVoxel * static_cast<float>(i / 3 % 3);
      lattice[i][2] = z + 4 * kVoxel * static_cast<float>(i % 3);
    }
    const Block before = RandomBlock(&random_);
    const bool none[kLatticeCells] = {};
    Block anywhere = before, marked = before;
    FuseWarpedLeaf(image.view(), lattice, none, anywhere.leaf());
    FuseWarpedLeaf(image.view(), lattice, foreign, marked.leaf());
    EXPECT_FALSE(anywhere == before);
    for (int i = 0; i < 512; ++i) {
      const int cell = 4 * (i / 256) + 2 * (i / 32 % 2) + i / 4 % 2;
      const bool is_kept = foreign[cell] && z > 0.9f;
      const Block& expected = is_kept ? before : anywhere;
      EXPECT_EQ(marked.weight[i], expected.weight[i]) << z << " " << i;
      EXPECT_EQ(marked.distance[i], expected.distance[i]) << z << " " << i;
    }
  }
}

TEST_F(VoxelFusion, FreeSpaceThatIsKnownWellDoesNotChange) {
  seen_ = ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1.5));
  const TsdfOptions options = {kVoxel, 0.04, 20};
  const FusionImage image(seen_, options, 1);
  Block block;
  block.distance.fill(static_cast<float>(options.truncation));
  block.weight.fill(0);
  block.color.fill(0);
  const float steps[3][3] = {{kVoxel, 0, 0}, {0, kVoxel, 0}, {0, 0, kVoxel}};
  const auto fuse_into = [&](const FusionImage& seen) {
    return FuseRigidLeaf(seen.view(), steps,
                         {{0, 0, 1}, kInfinity, block.leaf()}, block.leaf());
  };
  const auto fuse = [&](float weight) {
    block.weight.fill(weight);
    return fuse_into(image);
  };
  EXPECT_TRUE(fuse(0));  // Observed for the first time.
  EXPECT_FALSE(fuse(kFirmWeight + 1));
  // Pixels that say nothing change nothing.
  seen_.role.setTo(static_cast<int>(PixelRole::kNone));
  const FusionImage nothing(seen_, options, 1);
  block.weight.fill(0);
  EXPECT_FALSE(fuse_into(nothing));
}

}  // namespace
}  // namespace internal
}  // namespace splitfusion
