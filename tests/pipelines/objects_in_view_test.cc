#include "splitfusion/pipelines/objects_in_view.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/sample_depth.h"

namespace splitfusion {
namespace {

const cv::Rect kSeenBox(50, 40, 60, 40);

/// A wall at 1.5 m, and a box before it, at 1 m, that is surface 1.
LiveView ViewOfBox() {
  cv::Mat_<float> depth = WallDepth(SmallCamera(), 1.5);
  depth(kSeenBox).setTo(1.0f);
  LiveView live = MakeLiveView(SmallCamera(), depth,
                               PlainColor(SmallCamera(), {10, 200, 30}));
  live.labels(kSeenBox).setTo(1);
  return live;
}

SurfaceMap BoxBeforeWall() {
  SurfaceMap surfaces;
  surfaces[0] = std::make_unique<Surface>(0, "background", SurfaceKind::kRigid,
                                          0, SurfaceOptions());
  surfaces[1] = std::make_unique<Surface>(1, "box", SurfaceKind::kNonRigid, 0,
                                          SurfaceOptions());
  for (const auto& [id, surface] : surfaces) {
    EXPECT_TRUE(surface->Initialize(ViewOfBox()));
  }
  return surfaces;
}

std::vector<SurfaceReport> LookAt(const SurfaceMap& surfaces,
                                  const LiveView& live) {
  constexpr int kStride = 2;
  return LookAtObjects(surfaces,
                       RenderMeshes(surfaces, live.camera.Subsampled(kStride)),
                       live, kStride);
}

TEST(LookAtObjects, ReportsAllSurfacesButTheBackground) {
  const std::vector<SurfaceReport> objects =
      LookAt(BoxBeforeWall(), ViewOfBox());
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].id, 1);
  EXPECT_EQ(objects[0].pixels, kSeenBox.area());
  EXPECT_EQ(objects[0].exposure, 1);
}

TEST(LookAtObjects, WhatIsHiddenIsNotExposed) {
  LiveView live = ViewOfBox();
  const cv::Rect hidden(50, 40, 45,
                        40);  // Three quarters, by something at 0.6.
  live.depth(hidden).setTo(0.6f);
  live.labels(hidden).setTo(0);
  const std::vector<SurfaceReport> objects = LookAt(BoxBeforeWall(), live);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].pixels, kSeenBox.area() - hidden.area());
  // Every eighth column is looked at: one of seven more or less.
  EXPECT_NEAR(objects[0].exposure, 0.25, 1.0 / 7);
}

TEST(LookAtObjects, ASurfaceThatIsNotDrawnHasNoPixels) {
  const SurfaceMap surfaces = BoxBeforeWall();
  surfaces.at(1)->set_inactive(true);
  LiveView live = ViewOfBox();
  live.labels.setTo(0);
  const std::vector<SurfaceReport> objects = LookAt(surfaces, live);
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_EQ(objects[0].pixels, 0);
}

TEST(IsEnoughInView, AsksForPixelsAndForAShareOfTheModel) {
  const PipelineOptions options;
  SurfaceReport report;
  report.pixels = options.min_tracked_pixels;
  report.exposure = options.min_exposure;
  EXPECT_TRUE(IsEnoughInView(report, options));
  report.exposure = 0.99 * options.min_exposure;
  EXPECT_FALSE(IsEnoughInView(report, options));
  report.exposure = 1;
  --report.pixels;
  EXPECT_FALSE(IsEnoughInView(report, options));
}

}  // namespace
}  // namespace splitfusion
