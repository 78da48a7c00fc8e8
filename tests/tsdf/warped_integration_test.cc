#include "splitfusion/lib/tsdf/warped_integration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/lib/geometry/kd_tree.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

constexpr double kWarpedVoxel = 0.005;
const TsdfOptions kWarpedOptions = {kWarpedVoxel, 0.03, 64};

/// A plate around the optical axis at z = 1 m, canonical frame.
TriangleMesh CenteredPlate() {
  return SheetMesh(0.3, 0.2, 0.01, [](double x, double y) {
    return Eigen::Vector3d(x - 0.15, y - 0.1, 1);
  });
}

TriangleMesh Moved(
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  TriangleMesh mesh = CenteredPlate();
  for (Eigen::Vector3f& v : mesh.vertices) {
    v = map(v.cast<double>()).cast<float>();
  }
  return mesh;
}

/// 320x240 pixels, so that a voxel is about a pixel.
PinholeCamera Camera() {
  PinholeCamera camera = SmallCamera();
  camera.width *= 2, camera.height *= 2;
  camera.fx *= 2, camera.fy *= 2, camera.cx *= 2, camera.cy *= 2;
  return camera;
}

class WarpedIntegration : public ::testing::Test {
 protected:
  WarpedIntegration()
      : graph_(CoverWithNodes(CenteredPlate(), 0.03)),
        index_(graph_, 6),
        volume_(kWarpedOptions) {
    AllocateAround(graph_.positions, kReach, &volume_);
  }

  void Integrate(const TriangleMesh& live) {
    integrator_.Integrate(ObserveAll(Camera(), MeshDepth(Camera(), live)),
                          index_, WarpField(graph_), kReach, &volume_);
  }

  static constexpr double kReach = 0.06;
  DeformationGraph graph_;
  SkinningIndex index_;
  TsdfVolume volume_;
  WarpedIntegrator integrator_;
};

TEST_F(WarpedIntegration, ARigidWarpIsRigidIntegration) {
  const Rigid3d motion = MakeMotion({0.1, -0.2, 0.3}, {0.02, 0.01, 0.05});
  ApplyRigidMotion(motion, &graph_);
  const TriangleMesh live =
      Moved([&](const Eigen::Vector3d& p) { return motion * p; });
  Integrate(live);
  TsdfVolume rigid(kWarpedOptions);
  AllocateAround(graph_.positions, kReach, &rigid);
  IntegrateRigid(ObserveAll(Camera(), MeshDepth(Camera(), live)), motion,
                 &rigid);
  const TriangleMesh a = ExtractMesh(volume_, 0.5);
  const TriangleMesh b = ExtractMesh(rigid, 0.5);
  ASSERT_GT(a.vertices.size(), 1500u);
  // A voxel centre on the border of two pixels may fall to either.
  EXPECT_NEAR(static_cast<double>(a.vertices.size()) / b.vertices.size(), 1,
              0.01);
  const KdTree tree(b.vertices);
  int apart = 0;
  for (const Eigen::Vector3f& v : a.vertices) {
    apart += tree.HasNear(v, 1e-4) ? 0 : 1;
  }
  EXPECT_LT(apart, 0.02 * a.vertices.size());
}

TEST_F(WarpedIntegration, ABentPlateComesBackFlat) {
  const auto bend = [](const Eigen::Vector3d& p) { return Bend(p, 1, 2.0); };
  MoveNodes(bend, &graph_);
  Integrate(Moved(bend));
  const TriangleMesh mesh = ExtractMesh(volume_, 0.5);
  ASSERT_GT(mesh.vertices.size(), 1500u);
  double sum = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    sum += std::abs(v.z() - 1);
    EXPECT_LT(std::abs(v.z() - 1), 1.0 * kWarpedVoxel);  // Bent by 22 mm.
  }
  EXPECT_LT(sum / mesh.vertices.size(), 0.3 * kWarpedVoxel);
}

TEST_F(WarpedIntegration, MotionsThroughTimeFuseIntoOnePlate) {
  for (const double curvature : {0.01, 0.7, 1.4, -1.0}) {
    const auto bend = [&](const Eigen::Vector3d& p) {
      return Bend(p, 1, curvature);
    };
    MoveNodes(bend, &graph_);
    Integrate(Moved(bend));
  }
  int off = 0;
  const TriangleMesh mesh = ExtractMesh(volume_, 3.5);
  ASSERT_GT(mesh.vertices.size(), 1200u);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    off += std::abs(v.z() - 1) > 0.5 * kWarpedVoxel;
  }
  EXPECT_LT(off, 0.02 * mesh.vertices.size());
}

TEST_F(WarpedIntegration, SkinningFollowsTheGraph) {
  TsdfVolume control(kWarpedOptions);
  AllocateAround(graph_.positions, kReach, &control);
  const DepthObservation seen =
      ObserveAll(Camera(), MeshDepth(Camera(), CenteredPlate()));
  const auto fuse = [&](WarpedIntegrator* integrator, TsdfVolume* volume) {
    integrator->Integrate(seen, index_, WarpField(graph_), kReach, volume);
  };
  WarpedIntegrator first, anew;
  fuse(&integrator_, &volume_);
  fuse(&first, &control);
  const SkinningIndex before = index_;
  const int old_size = graph_.size();
  graph_.positions.push_back({0.16, 0.05, 1.02});
  graph_.motions.push_back({Eigen::Matrix3d::Identity(), {0.01, 0, 0.02}});
  graph_.neighbors.push_back({old_size - 2, old_size - 1});
  for (const int i : graph_.neighbors.back()) {
    graph_.neighbors[i].push_back(old_size);
  }
  for (TsdfVolume* volume : {&volume_, &control}) {
    AllocateAround({graph_.positions.back()}, kReach, volume);
  }
  index_ = SkinningIndex(graph_, 6);
  NodeChange nodes = NodeChange::None(old_size);
  nodes.added = 1;
  integrator_.FollowGraph(index_, SkinningChange(before, index_, graph_, nodes),
                          volume_);
  fuse(&integrator_, &volume_);
  fuse(&anew, &control);
  const TriangleMesh mesh = ExtractMesh(volume_, 0.5);
  const TriangleMesh expected = ExtractMesh(control, 0.5);
  ASSERT_GT(mesh.vertices.size(), 1500u);
  EXPECT_EQ(mesh.vertices, expected.vertices);
}

TEST_F(WarpedIntegration, SkinningFollowsAGraphThatForgetsNodes) {
  // Blocks of the far end are then beyond the reach of every node.
  constexpr double kShortReach = 0.03;
  TsdfVolume control(kWarpedOptions);
  AllocateAround(graph_.positions, kReach, &control);
  const DepthObservation seen =
      ObserveAll(Camera(), MeshDepth(Camera(), CenteredPlate()));
  const auto fuse = [&](WarpedIntegrator* integrator, TsdfVolume* volume) {
    integrator->Integrate(seen, index_, WarpField(graph_), kShortReach, volume);
  };
  WarpedIntegrator first, anew;
  fuse(&integrator_, &volume_);
  fuse(&first, &control);
  const SkinningIndex before = index_;
  NodeChange nodes{graph_.size(), {}, 0};
  for (int i = 0; i < graph_.size(); ++i) {
    if (graph_.positions[i].x() < 0.05) nodes.kept.push_back(i);
  }
  ASSERT_GT(nodes.forgotten(), 5);
  const std::vector<int> numbers = nodes.Numbers();
  nodes.Apply(&graph_.positions);
  nodes.Apply(&graph_.motions);
  nodes.Apply(&graph_.neighbors);
  for (std::vector<int>& row : graph_.neighbors) {
    std::vector<int> kept;
    for (const int j : row) {
      if (numbers[j] >= 0) kept.push_back(numbers[j]);
    }
    row = kept;
  }
  Shake(0.01, /*seed=*/3, &graph_);
  index_ = SkinningIndex(graph_, 6);
  integrator_.FollowGraph(index_, SkinningChange(before, index_, graph_, nodes),
                          volume_);
  fuse(&integrator_, &volume_);
  fuse(&anew, &control);
  const TriangleMesh mesh = ExtractMesh(volume_, 0.5);
  ASSERT_GT(mesh.vertices.size(), 1000u);
  EXPECT_EQ(mesh.vertices, ExtractMesh(control, 0.5).vertices);
}

TEST_F(WarpedIntegration, LeavesWhatIsAstrayAlone) {
  for (int i = 0; i < 3; ++i) Integrate(CenteredPlate());
  const auto count_right = [&] {
    int count = 0;
    for (const auto& v : ExtractMesh(volume_, 0.5).vertices) {
      count += v.x() > 0.08f;
    }
    return count;
  };
  const int before = count_right();
  ASSERT_GT(before, 200);
  // A wall far behind the plate, which carves it.
  const DepthObservation wall = ObserveAll(Camera(), WallDepth(Camera(), 2));
  std::vector<char> right(graph_.size());
  for (int i = 0; i < graph_.size(); ++i) {
    right[i] = graph_.positions[i].x() > 0;
  }
  for (int i = 0; i < 9; ++i) {
    integrator_.Integrate(wall, index_, WarpField(graph_), kReach, &volume_,
                          right);
  }
  EXPECT_EQ(count_right(), before);
  for (int i = 0; i < 9; ++i) {
    integrator_.Integrate(wall, index_, WarpField(graph_), kReach, &volume_);
  }
  EXPECT_EQ(count_right(), 0);
}

TEST_F(WarpedIntegration, WhatBelongsElsewhereIsNotCopied) {
  // Both halves of the graph lie upon the left half of the plate.
  for (int i = 0; i < graph_.size(); ++i) {
    if (graph_.positions[i].x() > 0) graph_.motions[i].translation.x() = -0.15;
  }
  DepthObservation seen =
      ObserveAll(Camera(), MeshDepth(Camera(), CenteredPlate()));
  const auto count_right = [&] {
    int count = 0;
    for (const auto& v : ExtractMesh(volume_, 0.5).vertices) {
      count += v.x() > 0.1f;
    }
    return count;
  };
  // As if every pixel belonged where it is seen.
  seen.places.create(seen.depth.size());
  for (int v = 0; v < seen.depth.rows; ++v) {
    for (int u = 0; u < seen.depth.cols; ++u) {
      const Eigen::Vector3f p =
          Camera().BackProject<float>(u, v, std::max(1.0f, seen.depth(v, u)));
      seen.places(v, u) = {p.x(), p.y(), p.z()};
    }
  }
  seen.place_tolerance = 0.08;
  const WarpField warp(graph_);
  integrator_.Integrate(seen, index_, warp, kReach, &volume_);
  EXPECT_EQ(count_right(), 0);
  EXPECT_GT(ExtractMesh(volume_, 0.5).vertices.size(), 700u);
  seen.places.release();
  integrator_.Integrate(seen, index_, warp, kReach, &volume_);
  EXPECT_GT(count_right(), 200) << "the second copy";
}

TEST_F(WarpedIntegration, BlocksOutOfReachAreLeftAlone) {
  // A second plate, 0.3 m aside, where there is no node.
  const Rigid3d aside = MakeMotion({0, 0, 0}, {0.3, 0, 0});
  AllocateAround({aside * Eigen::Vector3d(0.1, 0, 1)}, 0.08, &volume_);
  TriangleMesh live = CenteredPlate();
  AppendMesh(Moved([&](const Eigen::Vector3d& p) { return aside * p; }), &live);
  Integrate(live);
  for (const Eigen::Vector3f& v : ExtractMesh(volume_, 0.5).vertices) {
    EXPECT_LT(v.x(), 0.15 + kReach + 8 * kWarpedVoxel);
  }
}

}  // namespace
}  // namespace splitfusion
