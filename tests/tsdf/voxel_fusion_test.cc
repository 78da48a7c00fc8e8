// Block-wise fusion against the update written down voxel by voxel.

#include "splitfusion/lib/tsdf/internal/voxel_fusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/tsdf/internal/fusion_image.h"
#include "support/sample_depth.h"

namespace splitfusion {
namespace internal {
namespace {

constexpr float kVoxel = 0.01f;
const FusedPart kAll = {std::numeric_limits<float>::infinity(), false};
const TsdfOptions kOptions = {kVoxel, 0.04, 20, 5};

/// A block's voxels.
struct Block {
  std::array<float, 512> distance, weight;
  std::array<float, 1536> color;

  FusedLeaf leaf() { return {distance.data(), weight.data(), color.data()}; }
  bool operator==(const Block& other) const {
    return distance == other.distance && weight == other.weight &&
           color == other.color;
  }
};

Block RandomBlock(std::mt19937* random) {
  std::uniform_real_distribution<float> unit(0, 1);
  Block block;
  for (float& d : block.distance) d = 0.08f * unit(*random) - 0.04f;
  for (float& w : block.weight) w = 30 * unit(*random) - 10;
  for (float& w : block.weight) w = std::max(w, 0.0f);  // Unseen: a third.
  for (float& c : block.color) c = unit(*random);
  return block;
}

/// Slanted wall with holes, of pixels of all roles and weights.
DepthObservation RandomObservation(std::mt19937* random) {
  DepthObservation observation = ObserveAll(
      SmallCamera(), PlaneDepth(SmallCamera(), {0.3, 0.1, 0.9}, 1.0));
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

/// Kinect Fusion's update of one voxel at `p` of the camera frame.
void UpdateVoxel(const DepthObservation& seen, const Eigen::Vector3f& p, int i,
                 Block* block) {
  const auto truncation = static_cast<float>(kOptions.truncation);
  if (!(p.z() > 0.05f)) return;
  const float inverse_z = 1 / p.z();
  const auto pixel = [&](double f, float x, double c) {
    return static_cast<int>(std::lround(static_cast<float>(f) * x * inverse_z +
                                        static_cast<float>(c)));
  };
  const int u = pixel(seen.camera.fx, p.x(), seen.camera.cx);
  const int v = pixel(seen.camera.fy, p.y(), seen.camera.cy);
  if (u < 0 || v < 0 || u >= seen.camera.width || v >= seen.camera.height) {
    return;
  }
  const auto role = static_cast<PixelRole>(seen.role(v, u));
  const float depth = seen.depth(v, u);
  if (role == PixelRole::kNone || !(depth > 0)) return;
  const float sdf = depth - p.z();
  const bool in_band = role == PixelRole::kWrite && sdf >= -truncation;
  if (!in_band && sdf <= truncation) return;
  const bool empty = sdf > truncation + 3 * DepthSigma(depth);
  const float confidence = empty ? 3.0f : seen.weight(v, u);
  const float sum = block->weight[i] + confidence;
  if (!(sum > 0)) return;
  const float blend = confidence / sum;
  float& distance = block->distance[i];
  distance += blend * (std::min(sdf, truncation) - distance);
  for (int k = 0; k < 3 && in_band && std::abs(sdf) < truncation; ++k) {
    const float value = seen.color.at<cv::Vec3b>(v, u)[2 - k] / 255.0f;
    block->color[3 * i + k] += blend * (value - block->color[3 * i + k]);
  }
  const bool emptied = empty && distance > 0.9f * truncation;
  block->weight[i] =
      std::min(sum, static_cast<float>(emptied ? kOptions.max_free_weight
                                               : kOptions.max_weight));
}

/// A block somewhere around the wall: its first voxel and steps.
struct Placement {
  Eigen::Vector3f base;
  Eigen::Matrix3f steps;

  Eigen::Vector3f At(int x, int y) const {
    return base + static_cast<float>(x) * steps.col(0) +
           static_cast<float>(y) * steps.col(1);
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
  FusionImage image_{seen_, kOptions};
};

TEST_F(VoxelFusion, ARigidBlockIsUpdatedVoxelByVoxel) {
  int changed_blocks = 0;
  for (int round = 0; round < 300; ++round) {
    const Placement at = RandomPlacement(&random_);
    Block block = RandomBlock(&random_);
    const Block before = block;
    Block expected = block;
    for (int i = 0, x = 0; x < 8; ++x) {
      for (int y = 0; y < 8; ++y) {
        Eigen::Vector3f p = at.At(x, y);
        for (int z = 0; z < 8; ++z, ++i, p += at.steps.col(2)) {
          UpdateVoxel(seen_, p, i, &expected);
        }
      }
    }
    float steps[3][3];
    for (int i = 0; i < 9; ++i) steps[i / 3][i % 3] = at.steps(i % 3, i / 3);
    const bool changed =
        FuseRigidLeaf(image_.view(), at.base.data(), steps, kAll, block.leaf());
    EXPECT_TRUE(block == expected) << "round " << round;
    EXPECT_TRUE(changed || block.distance == before.distance);
    EXPECT_TRUE(changed || block.color == before.color);
    changed_blocks += changed;
    // No block that changes may be passed over.
    float corners[8][3];
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3f corner =
          at.At(7 * (i & 1), 7 * ((i >> 1) & 1)) +
          7 * static_cast<float>((i >> 2) & 1) * at.steps.col(2);
      std::copy_n(corner.data(), 3, corners[i]);
    }
    const ImageBox box = BoundInImage(image_.view(), corners, 8);
    const FusedPart part = image_.MayChange(box);
    EXPECT_TRUE(box.z_low < part.farthest || block == before);
    // Nor any part of one.
    Block bounded = before;
    FuseRigidLeaf(image_.view(), at.base.data(), steps, part, bounded.leaf());
    EXPECT_TRUE(bounded == expected) << "round " << round;
  }
  EXPECT_GT(changed_blocks, 50);
  EXPECT_LT(changed_blocks, 250);
}

TEST_F(VoxelFusion, AWarpedBlockIsUpdatedWhereItsLatticeCarriesIt) {
  std::uniform_real_distribution<float> noise(-0.01f, 0.01f);
  for (int round = 0; round < 100; ++round) {
    const Placement at = RandomPlacement(&random_);
    float lattice[kLatticePoints][3];
    for (int i = 0; i < kLatticePoints; ++i) {
      for (int k = 0; k < 3; ++k) {
        lattice[i][k] = (at.At(4 * (i / 9), 4 * (i / 3 % 3)) +
                         4 * static_cast<float>(i % 3) * at.steps.col(2))[k] +
                        noise(random_);
      }
    }
    Block block = RandomBlock(&random_);
    Block expected = block;
    const auto mix = [](float a, float b, int voxel) {
      return a + static_cast<float>(voxel % 4) / 4 * (b - a);
    };
    for (int i = 0; i < 512; ++i) {
      const int x = i / 64, y = i / 8 % 8, z = i % 8;
      Eigen::Vector3f p;
      for (int k = 0; k < 3; ++k) {
        const auto value = [&](int dx, int dy, int dz) {
          return lattice[9 * (x / 4 + dx) + 3 * (y / 4 + dy) + z / 4 + dz][k];
        };
        float along_z[2];
        for (int dz = 0; dz < 2; ++dz) {
          along_z[dz] = mix(mix(value(0, 0, dz), value(1, 0, dz), x),
                            mix(value(0, 1, dz), value(1, 1, dz), x), y);
        }
        p[k] = mix(along_z[0], along_z[1], z);
      }
      UpdateVoxel(seen_, p, i, &expected);
    }
    const Block before = block;
    const bool foreign[kLatticeCells] = {};
    FuseWarpedLeaf(image_.view(), lattice, foreign, block.leaf());
    EXPECT_TRUE(block == expected) << "round " << round;
    const ImageBox box = BoundInImage(image_.view(), lattice, kLatticePoints);
    EXPECT_TRUE(box.z_low < image_.MayChange(box).farthest || block == before);
  }
}

TEST_F(VoxelFusion, IntoForeignCellsOnlyFreeSpaceIsFused) {
  // Blocks before, in and behind a wall at 1 m.
  seen_ = ObserveAll(SmallCamera(), WallDepth(SmallCamera(), 1));
  const FusionImage image(seen_, kOptions);
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
  const TsdfOptions options = {kVoxel, 0.04, 20, 20};
  const FusionImage image(seen_, options);
  Block block;
  block.distance.fill(static_cast<float>(options.truncation));
  block.weight.fill(0);
  block.color.fill(0);
  const float base[3] = {0, 0, 1};
  const float steps[3][3] = {{kVoxel, 0, 0}, {0, kVoxel, 0}, {0, 0, kVoxel}};
  const auto fuse = [&](float weight) {
    block.weight.fill(weight);
    return FuseRigidLeaf(image.view(), base, steps, kAll, block.leaf());
  };
  EXPECT_TRUE(fuse(0));  // Observed for the first time.
  EXPECT_FALSE(fuse(kFirmWeight + 1));
  // Pixels that say nothing change nothing.
  seen_.role.setTo(static_cast<int>(PixelRole::kNone));
  const FusionImage nothing(seen_, options);
  block.weight.fill(0);
  EXPECT_FALSE(FuseRigidLeaf(nothing.view(), base, steps, kAll, block.leaf()));
}

}  // namespace
}  // namespace internal
}  // namespace splitfusion
