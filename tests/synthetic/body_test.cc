#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/synthetic/body_model.h"
#include "splitfusion/lib/synthetic/body_motion.h"
#include "splitfusion/lib/synthetic/body_skeleton.h"
#include "splitfusion/lib/synthetic/implicit_mesher.h"
#include "splitfusion/lib/synthetic/soft_object.h"
#include "synthetic/mesh_checks.h"

namespace splitfusion {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const BodyModel& Body() {
  static const BodyModel* const body = new BodyModel(1);
  return *body;
}

TriangleMesh Posed(const std::vector<Vector3f>& vertices,
                   const TriangleMesh& rest) {
  TriangleMesh mesh = rest;
  mesh.vertices = vertices;
  return mesh;
}

/// Largest distance that a vertex moves from one frame to the next.
double LargestStep(const std::vector<Vector3f>& a,
                   const std::vector<Vector3f>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

/// Share of edges that are longer than `factor` times their rest length.
double StretchedEdges(const TriangleMesh& posed, const TriangleMesh& rest,
                      float factor) {
  double stretched = 0;
  for (const Eigen::Vector3i& t : rest.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      stretched += (posed.vertices[a] - posed.vertices[b]).norm() >
                   factor * (rest.vertices[a] - rest.vertices[b]).norm();
    }
  }
  return stretched / (3.0 * static_cast<double>(rest.triangles.size()));
}

TEST(MeshRoundCones, ACapsuleIsClosedAndExact) {
  const RoundCone capsule{{0, 0, 0}, {0, 0, 0.3f}, 0.1f, 0.1f, 0};
  const TriangleMesh mesh = MeshRoundCones({capsule}, 0.05f, 0.02f);
  EXPECT_TRUE(IsClosed(mesh));
  const double volume = M_PI * 0.01 * (0.3 + 4.0 / 3 * 0.1);
  EXPECT_NEAR(SignedVolume(mesh), volume, 0.02 * volume);
  for (const Vector3f& vertex : mesh.vertices) {
    ASSERT_NEAR(SignedDistance(capsule, vertex), 0, 1e-4);
  }
}

TEST(MeshRoundCones, ConesThatMeetBecomeOneSurface) {
  const TriangleMesh mesh =
      MeshRoundCones({{{0, 0, 0}, {0, 0, 0.3f}, 0.08f, 0.06f, 0},
                      {{0, 0, 0.3f}, {0.3f, 0, 0.3f}, 0.06f, 0.04f, 1}},
                     0.04f, 0.02f);
  EXPECT_TRUE(IsClosed(mesh));
  // Euler characteristic of one sphere: V - E + F = V - F / 2 = 2.
  EXPECT_EQ(mesh.vertices.size() * 2 - mesh.triangles.size(), 4u);
}

TEST(NearestBone, IsThatOfTheNearestSurface) {
  const std::vector<RoundCone> cones = {{{0, 0, 0}, {0, 0, 1}, 0.1f, 0.1f, 4},
                                        {{1, 0, 0}, {1, 0, 1}, 0.1f, 0.1f, 9}};
  EXPECT_EQ(NearestBone(cones, {0.3f, 0, 0.5f}), 4);
  EXPECT_EQ(NearestBone(cones, {0.7f, 0, 0.5f}), 9);
}

TEST(BodyModel, IsOneClosedSurfaceOfHumanSize) {
  const TriangleMesh& mesh = Body().rest().mesh;
  EXPECT_TRUE(IsClosed(mesh));
  EXPECT_EQ(mesh.vertices.size() * 2 - mesh.triangles.size(), 4u);
  EXPECT_GT(SignedVolume(mesh), 0.045);  // m^3
  EXPECT_LT(SignedVolume(mesh), 0.085);
  float low = 1, high = 0;
  for (const Vector3f& vertex : mesh.vertices) {
    low = std::min(low, vertex.z());
    high = std::max(high, vertex.z());
  }
  EXPECT_NEAR(low, 0, 0.01);
  EXPECT_NEAR(high, 1.75, 0.03);
}

TEST(BodyModel, RestJointsMeetTheirParents) {
  for (int bone = 0; bone < BodyModel::kBones; ++bone) {
    EXPECT_LE(BodyParent(bone), bone);
    const double length =
        (BodyRestJoint(bone) - BodyRestJoint(BodyParent(bone))).norm();
    EXPECT_LT(length, 0.5) << bone;
  }
}

TEST(BodyModel, BonesKeepTheirLengthInEveryPose) {
  const BodyMotion motion(true);
  for (const double time : {0.0, 1.7, 2.4, 7.9, 13.0, 18.2}) {
    const auto bones = BodyBoneTransforms(motion.PoseAt(time));
    for (int bone = 0; bone < BodyModel::kBones; ++bone) {
      const Vector3d joint = BodyRestJoint(bone);
      // The joint is where the parent's motion carries it.
      EXPECT_LT((bones[bone] * joint - bones[BodyParent(bone)] * joint).norm(),
                1e-9)
          << "bone " << bone << " at " << time;
    }
  }
}

TEST(BodyModel, ARigidMotionOfThePoseMovesTheMeshRigidly) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = ExpSo3({0, 0, 0.8});
  motion.translation() = Vector3d(1, -2, 0.3);
  const BodyPose pose = BodyMotion(true).PoseAt(2.2);
  BodyPose moved = pose;
  moved.world_from_pelvis = motion * pose.world_from_pelvis;
  for (FootPose& foot : moved.feet) {
    foot.ankle = motion * foot.ankle;
    foot.heading += 0.8;
  }
  const auto a = Body().Vertices(pose), b = Body().Vertices(moved);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3f expected = (motion * a[i].cast<double>()).cast<float>();
    ASSERT_LT((b[i] - expected).norm(), 2e-5f);
  }
}

TEST(BodyMotion, SkinNeverTears) {
  const BodyMotion motion(true);
  const TriangleMesh& rest = Body().rest().mesh;
  for (double time = 0; time < 20; time += 0.5) {
    const TriangleMesh posed =
        Posed(Body().Vertices(motion.PoseAt(time)), rest);
    EXPECT_LT(StretchedEdges(posed, rest, 1.8f), 0.02) << time;
    const double change = SignedVolume(posed) / SignedVolume(rest);
    EXPECT_NEAR(change, 1, 0.06) << time;
  }
}

TEST(BodyMotion, MovesSmoothlyAtHumanSpeed) {
  const BodyMotion motion(true);
  auto last = Body().Vertices(motion.PoseAt(0));
  for (int frame = 1; frame <= 600; ++frame) {
    const auto now = Body().Vertices(motion.PoseAt(frame / 30.0));
    ASSERT_LT(LargestStep(now, last), 0.1) << frame;  // 3 m/s: a hand.
    last = now;
  }
}

TEST(BodyMotion, PlantedFeetDoNotSlide) {
  const BodyMotion motion(true);
  int planted = 0;
  for (int frame = 0; frame < 600; ++frame) {
    const BodyPose now = motion.PoseAt(frame / 30.0);
    const BodyPose next = motion.PoseAt((frame + 1) / 30.0);
    for (const int side : {0, 1}) {
      const Vector3d& ankle = now.feet[side].ankle;
      const Vector3d& later = next.feet[side].ankle;
      if (ankle.z() > 0.0831 || later.z() > 0.0831) continue;
      ++planted;
      EXPECT_LT((ankle - later).norm(), 2e-3) << frame;
    }
  }
  EXPECT_GT(planted, 600);  // Half of the time at least.
}

TEST(BodyMotion, FeetReachThePlaceWhereTheyStand) {
  const BodyMotion motion(true);
  for (int frame = 0; frame < 600; frame += 3) {
    const BodyPose pose = motion.PoseAt(frame / 30.0);
    const auto bones = BodyBoneTransforms(pose);
    for (const int side : {0, 1}) {
      const int foot = kFoot + side;
      EXPECT_LT(
          (bones[foot] * BodyRestJoint(foot) - pose.feet[side].ankle).norm(),
          0.03)
          << frame;
    }
  }
}

TEST(BodyMotion, WalksBendsAndGestures) {
  const BodyMotion motion(true);
  const BodyPose start = motion.PoseAt(0), bent = motion.PoseAt(2.5);
  EXPECT_GT((start.world_from_pelvis.translation() -
             bent.world_from_pelvis.translation())
                .norm(),
            0.3);
  const auto head_tilt = [](const BodyPose& pose) {
    const Rigid3d chest = BodyBoneTransforms(pose)[kChest];
    return std::acos(chest.linear()(2, 2));
  };
  EXPECT_LT(head_tilt(start), 0.15);
  EXPECT_GT(head_tilt(bent), 0.75);  // Radians: 43 degrees.
  EXPECT_GT(start.arms[1].fore.normalized().z(), 0.5);
}

TEST(BodyMotion, WithoutWalkingThePersonStaysInPlace) {
  const BodyMotion motion(false);
  for (const double time : {0.0, 3.3, 9.1}) {
    const Vector3d pelvis = motion.PoseAt(time).world_from_pelvis.translation();
    EXPECT_LT(pelvis.head<2>().norm(), 0.25) << time;
  }
}

TEST(SoftObject, IsClosedAndKeepsItsVolume) {
  const SoftObject toy(Vector3f::Zero(), 1);
  const TriangleMesh& rest = toy.rest().mesh;
  EXPECT_TRUE(IsClosed(rest));
  for (const double time : {0.0, 1.0, 2.7}) {
    const TriangleMesh posed = Posed(toy.Vertices(time), rest);
    EXPECT_NEAR(SignedVolume(posed) / SignedVolume(rest), 1, 0.06) << time;
    EXPECT_LT(StretchedEdges(posed, rest, 1.6f), 0.01) << time;
  }
}

TEST(SoftObject, BendsWhileItsFootStaysPut) {
  const SoftObject toy(Vector3f(1, 2, 0.5f), 1);
  const auto a = toy.Vertices(0.2), b = toy.Vertices(2.0);
  float foot = 0, tip = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const float height = toy.rest().mesh.vertices[i].z();
    const float moved = (a[i] - b[i]).norm();
    if (height < 0.05f) foot = std::max(foot, moved);
    if (height > 0.42f) tip = std::max(tip, moved);
    EXPECT_GT(a[i].z(), 0.499f);  // Not through the table.
  }
  EXPECT_LT(foot, 0.03);
  EXPECT_GT(tip, 0.15);
}

}  // namespace
}  // namespace splitfusion
