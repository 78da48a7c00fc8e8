#include "splitfusion/lib/evaluation/point_follower.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/surface_attachment.h"
#include "support/bent_plate.h"
#include "support/motion_frames.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class FollowPointsTest : public ::testing::Test {
 protected:
  void Load() {
    std::filesystem::create_directories(folder_ / "run");
    plate_.WriteRun(folder_ / "run");
    run_ = ReadRun(folder_ / "run");
    surfaces_ = AnimateSurfaces(std::move(run_.surfaces));
  }

  /// Follows one point of the world of frame 0 through 10 frames.
  FollowedPoints Follow(const Eigen::Vector3d& point) {
    return FollowPoints(run_, surfaces_, {{7, 0, point}}, 10);
  }

  Eigen::Vector3d InCamera(const Eigen::Vector3d& point, int frame) const {
    return plate_.WorldFromCamera(frame).inverse() * point;
  }

  TemporaryFolder folder_;
  BentPlate plate_;
  RecordedRun run_;
  std::vector<AnimatedSurface> surfaces_;
};

TEST_F(FollowPointsTest, SurfacePointGoesWithTheWarp) {
  Load();
  const FollowedPoints followed = Follow({0.11, 0.05, 1});
  ASSERT_EQ(followed.points.size(), 11u);
  EXPECT_EQ(followed.attached, 1);
  for (const TrackPoint& point : followed.points) {
    EXPECT_EQ(point.id, 7);
    const Eigen::Vector3d truth =
        InCamera(plate_.PointAt(0.11, 0.05, point.frame), point.frame);
    EXPECT_LT((point.position - truth).norm(), 0.001);
  }
}

TEST_F(FollowPointsTest, OffsetFromTheSurfaceTurnsWithIt) {
  Load();
  const double offset = 0.02;
  const FollowedPoints followed = Follow({0.11, 0.05, 1 - offset});
  const TrackPoint& last = followed.points.back();
  // The normal of the rolled plate, towards the camera.
  const double angle = plate_.curvature_step * 10 * 0.11;
  const Eigen::Vector3d normal(std::sin(angle), 0, -std::cos(angle));
  const Eigen::Vector3d truth =
      plate_.PointAt(0.11, 0.05, 10) + offset * normal;
  EXPECT_LT((last.position - InCamera(truth, 10)).norm(), 0.001);
  // In its own frame it is exactly where it was given.
  EXPECT_LT(
      (followed.points[0].position - Eigen::Vector3d(0.11, 0.05, 1 - offset))
          .norm(),
      1e-6);
}

TEST_F(FollowPointsTest, PointInFreeSpaceStaysInTheWorld) {
  Load();
  const Eigen::Vector3d point(0, 0, 0.7);
  const FollowedPoints followed = Follow(point);
  EXPECT_EQ(followed.unattached, 1);
  EXPECT_LT((followed.points.back().position - InCamera(point, 10)).norm(),
            1e-6);
}

TEST_F(FollowPointsTest, SurfaceBornLaterTakesThePointUp) {
  plate_.first_frame = 2;
  plate_.curvature_step = 0.1;
  Load();
  const FollowedPoints followed = Follow({0.11, 0.05, 1});
  EXPECT_EQ(followed.attached, 1);
  const Eigen::Vector3d truth = InCamera(plate_.PointAt(0.11, 0.05, 10), 10);
  // It moved a little before it was attached.
  EXPECT_LT((followed.points.back().position - truth).norm(), 0.005);
}

TEST_F(FollowPointsTest, MasksOfTheRunAreUsed) {
  Load();
  const Eigen::Vector3d point(0, 0, 0.96);
  EXPECT_FALSE(Follow(point).by_mask);
  std::filesystem::create_directories(folder_ / "run/masks");
  cv::imwrite(folder_ / ("run/masks/" + BentPlate::Stem(0) + ".png"),
              cv::Mat(120, 160, CV_16UC1, cv::Scalar(1)));
  const FollowedPoints followed = Follow(point);
  EXPECT_TRUE(followed.by_mask);
  EXPECT_EQ(followed.attached, 1);
}

TEST_F(FollowPointsTest, RejectsForeignFrames) {
  Load();
  EXPECT_THROW(FollowPoints(run_, surfaces_, {{0, 99, {0, 0, 1}}}, 5),
               InputError);
  EXPECT_THROW(
      FollowPoints(run_, surfaces_, {{0, 0, {0, 0, 1}}, {1, 1, {0, 0, 1}}}, 5),
      InputError);
}

TEST_F(FollowPointsTest, GoesAsFarAsTheRun) {
  Load();
  const FollowedPoints followed =
      FollowPoints(run_, surfaces_, {{0, 8, {0, 0, 1}}}, 30);
  EXPECT_EQ(followed.points.size(), 4u);  // Frames 8 to 11.
}

/// Two parallel plates that face the camera, as surfaces of their own.
AnimatedSurface PlateSurface(int id, float z) {
  RecordedSurface surface;
  surface.id = id;
  surface.neighbors_per_point = 6;
  surface.graph = MakeRigidGraph(Rigid3d::Identity());
  surface.motions.Append({0, true, surface.graph.motions});
  surface.mesh.vertices = {{-1, -1, z}, {-1, 1, z}, {1, 1, z}, {1, -1, z}};
  surface.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return AnimatedSurface(surface);
}

TEST(AnimatedSurface, BeginsAnewWhereNothingGoesOn) {
  RecordedSurface surface = PlateSurface(1, 1).recorded();
  surface.graph.positions.resize(5);
  surface.graph.motions.resize(5);
  surface.graph.neighbors.resize(5);
  EditFrame(
      0, [](FrameMotions& frame) { frame.motions.resize(5); },
      &surface.motions);
  // Two refuted parts and the rest of a model, and the one that replaced it.
  surface.graph.parts = {{0, 0, 4}, {1, 6, 9}, {2, 0, 20}, {3, 20}};
  const AnimatedSurface plate(surface);
  EXPECT_TRUE(plate.BeginsIn(0));
  EXPECT_FALSE(plate.BeginsIn(6)) << "a part of a model that goes on";
  EXPECT_TRUE(plate.BeginsIn(20));
  EXPECT_TRUE(plate.EndsBetween(3, 4));
  EXPECT_TRUE(plate.EndsBetween(7, 12)) << "frames in between are missing";
  EXPECT_FALSE(plate.EndsBetween(4, 8));
}

TEST(SurfaceAttacher, PrefersMaskThenForegroundThenNearest) {
  const AnimatedSurface wall = PlateSurface(0, 1.00f);
  const AnimatedSurface person = PlateSurface(1, 0.98f);
  const AnimatedSurface chair = PlateSurface(2, 0.92f);
  const SurfaceAttacher attacher({&wall, &person, &chair}, 0);
  const auto id = [&](double z, int mask) {
    return attacher.Attach({0, 0, z}, mask)->surface->recorded().id;
  };
  EXPECT_EQ(id(0.999, 0), 1);  // Nearer to the wall, but the person is near.
  EXPECT_EQ(id(1.05, 0), 0);   // Too far from the person.
  EXPECT_EQ(id(0.98, 2), 2);   // The mask says so.
  EXPECT_EQ(id(1.05, 2), 0);   // Farther than the reach from the mask's.
  EXPECT_FALSE(attacher.Attach({0, 0, 2}, 1));
}

TEST(SurfaceAttacher, LeavesOutWhatFacesAway) {
  AnimatedSurface plate = PlateSurface(1, 1);
  RecordedSurface turned = plate.recorded();
  for (Eigen::Vector3i& t : turned.mesh.triangles) std::swap(t[0], t[1]);
  const AnimatedSurface back(turned);
  EXPECT_TRUE(SurfaceAttacher({&plate}, 0).Attach({0, 0, 1}, 0));
  EXPECT_FALSE(SurfaceAttacher({&back}, 0).Attach({0, 0, 1}, 0));
}

}  // namespace
}  // namespace splitfusion
