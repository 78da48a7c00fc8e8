#include "splitfusion/lib/visibility/recent_views.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/sample_depth.h"

namespace splitfusion {
namespace {

/// A wall at 2 m; its right half stands 0.5 m nearer and is surface 3.
LiveView View() {
  const PinholeCamera camera = SmallCamera();
  const cv::Rect right(camera.width / 2, 0, camera.width / 2, camera.height);
  cv::Mat_<float> depth = WallDepth(camera, 2);
  depth(right).setTo(1.5f);
  LiveView live =
      MakeLiveView(camera, depth, PlainColor(camera, {10, 200, 30}));
  live.labels(right).setTo(3);
  return live;
}

class RecentViewsTest : public ::testing::Test {
 protected:
  RecentViewsTest() { views_.Add(7, View()); }

  std::optional<Sighting> Look(double x, double z) const {
    return views_.Look(7, 3, {x, 0, z});
  }

  RecentViews views_;
};

TEST_F(RecentViewsTest, APointOnTheSurfaceIsSeen) {
  EXPECT_EQ(Look(0.2, 1.5), Sighting::kSeen);
  EXPECT_EQ(Look(0.2, 1.51), Sighting::kSeen);
  EXPECT_EQ(Look(0.2, 1.49), Sighting::kSeen);
  // Three sigma of the noise at 1.5 m are 10 mm; and 2 cm.
  EXPECT_EQ(Look(0.2, 1.525), Sighting::kSeen);
  EXPECT_EQ(Look(0.2, 1.475), Sighting::kSeen);
  EXPECT_EQ(Look(0.2, 1.54), Sighting::kUnknown);
  EXPECT_EQ(Look(0.2, 1.46), Sighting::kFreeSpace);
}

TEST_F(RecentViewsTest, APointJustBesideTheSilhouetteIsSeen) {
  const PinholeCamera camera = SmallCamera();
  const auto look = [&](double pixels_left) {
    const double u = camera.width / 2 - pixels_left;
    return Look((u - camera.cx) / camera.fx * 1.5, 1.5);
  };
  EXPECT_EQ(look(3), Sighting::kSeen);
  EXPECT_EQ(look(7), Sighting::kFreeSpace);
}

TEST_F(RecentViewsTest, APointBeforeWhatIsSeenIsInFreeSpace) {
  EXPECT_EQ(Look(0.2, 1.4), Sighting::kFreeSpace);
  EXPECT_EQ(Look(-0.2, 1.5), Sighting::kFreeSpace) << "before the wall";
}

TEST_F(RecentViewsTest, HiddenIsUnknown) {
  EXPECT_EQ(Look(0.2, 1.6), Sighting::kUnknown);
  EXPECT_EQ(Look(-0.2, 2), Sighting::kUnknown) << "on another surface";
}

TEST_F(RecentViewsTest, OutOfViewIsUnknown) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {-5.0, 5.0, 1e300, nan}) {
    EXPECT_EQ(Look(x, 1.5), Sighting::kUnknown) << x;
  }
  for (const double y : {-5.0, 5.0, 1e300, nan}) {
    EXPECT_EQ(views_.Look(7, 3, {0.2, y, 1.5}), Sighting::kUnknown) << y;
  }
  for (const double z : {-1.5, 0.0, nan}) {
    EXPECT_EQ(Look(0.2, z), Sighting::kUnknown) << z;
  }
}

TEST_F(RecentViewsTest, NoDepthIsUnknown) {
  LiveView blind = View();
  blind.depth.setTo(0);
  views_.Add(8, blind);
  EXPECT_EQ(views_.Look(8, 3, {0.2, 0, 1.5}), Sighting::kUnknown);
}

TEST_F(RecentViewsTest, OldFramesAreForgotten) {
  RecentViews views(2);
  for (const int frame : {3, 4, 6}) views.Add(frame, View());
  for (const int frame : {2, 3, 5, 7}) {
    EXPECT_FALSE(views.Look(frame, 3, {0.2, 0, 1.5})) << frame;
  }
  for (const int frame : {4, 6}) {
    EXPECT_EQ(views.Look(frame, 3, {0.2, 0, 1.5}), Sighting::kSeen) << frame;
  }
}

}  // namespace
}  // namespace splitfusion
