#include "splitfusion/lib/render/best_view_colors.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "render/plate_views.h"
#include "splitfusion/lib/base/pi.h"
#include "support/motion_frames.h"

namespace splitfusion {
namespace {

const cv::Vec3b kBlue(255, 0, 0);
const cv::Vec3b kGreen(0, 255, 0);

/// Takes colours from a frame.
void Add(int frame, const LiveView& live, BestViewColors* colors) {
  colors->Place(frame);
  colors->Add(live);
}

/// Index of the vertex nearest to the middle.
std::size_t Middle(const SurfaceModel& model) {
  const auto& vertices = model.mesh.vertices;
  return std::min_element(
             vertices.begin(), vertices.end(),
             [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
               return a.head<2>().norm() < b.head<2>().norm();
             }) -
         vertices.begin();
}

/// Colour of the middle after frames of these colours.
Color ColorOf(const SurfaceModel& model, const std::vector<cv::Vec3b>& bgr) {
  BestViewColors colors(kPlateSurface, model, 4);
  for (std::size_t f = 0; f < bgr.size(); ++f) {
    Add(model.history.frame(f), See(model, f, bgr[f]), &colors);
  }
  return colors.Colors()[Middle(model)];
}

/// Turned about the vertical axis through its middle.
Rigid3d Turned(double degrees) {
  const Rigid3d to_middle = Away(-1);
  return to_middle.inverse() *
         MakeMotion({0, degrees * kPi<double> / 180, 0}, {0, 0, 0}) * to_middle;
}

TEST(BestViewColors, AreThoseOfTheOneViewThatShowsIt) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  EXPECT_EQ(ColorOf(model, {kGreen}), (Color{0, 255, 0}));
}

TEST(BestViewColors, WeighPixelsPerArea) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  // Its middle does not move in the image, as it goes away along the axis.
  AddFrame(1, Away(0.5), &model);
  const Color color = ColorOf(model, {kGreen, kBlue});
  const double share = 1 / (1.5 * 1.5);
  EXPECT_NEAR(color[2], 255 * share / (1 + share), 6);
  EXPECT_NEAR(color[1], 255 / (1 + share), 6);
}

TEST(BestViewColors, ViewsFromTheSideCountLess) {
  SurfaceModel model = Plate();
  AddFrame(0, Turned(60), &model);
  AddFrame(1, Turned(0), &model);
  const Color color = ColorOf(model, {kBlue, kGreen});
  // A third, less what its depth is off within its pixel.
  EXPECT_LT(color[2], 255 / 3 + 6);
  EXPECT_GT(color[2], 25);
}

TEST(BestViewColors, WhatMovesInTheImageIsBlurred) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  // By 5 cm, in pixels.
  const double way = SmallCamera().fx * 0.05;
  AddFrame(1, MakeMotion({0, 0, 0}, {0.05, 0, 0}), &model);
  const double share = 1 / (1 + way / 2);
  EXPECT_NEAR(ColorOf(model, {kGreen, kBlue})[2], 255 * share / (1 + share), 6);
  // The same way in five frames.
  std::vector<FrameMotions> frames = FramesOf(model.history);
  frames[1].frame = 5;
  model.history = HistoryOf(frames);
  const double slow = 1 / (1 + way / 10);
  EXPECT_NEAR(ColorOf(model, {kGreen, kBlue})[2], 255 * slow / (1 + slow), 6);
}

TEST(BestViewColors, WhatLiesBesideLiveDepthIsNotSeen) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  BestViewColors colors(kPlateSurface, model, 4);
  const PinholeCamera camera = SmallCamera();
  for (const double z : {0.9, 1.1}) {
    Add(0, View(WallDepth(camera, z), kGreen), &colors);
  }
  EXPECT_EQ(colors.Colors(), model.mesh.colors);
}

TEST(BestViewColors, NorAreHiddenNodesAndLostFrames) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  EditFrame(
      0,
      [](FrameMotions& frame) {
        std::fill(frame.seen.begin(), frame.seen.end(), false);
      },
      &model.history);
  EXPECT_EQ(ColorOf(model, {kGreen}), kFused);
  // Of a frame that it has no motions of.
  BestViewColors colors(kPlateSurface, model, 4);
  Add(7, See(model, 0, kGreen), &colors);
  EXPECT_EQ(colors.Colors(), model.mesh.colors);
}

TEST(BestViewColors, BesideADepthEdgeIsTheColorOfSomethingElse) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  BestViewColors colors(kPlateSurface, model, 4);
  Add(0, See(model, 0, kGreen), &colors);
  const auto found = colors.Colors();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float rim = std::min(0.15f - std::abs(model.mesh.vertices[i].x()),
                               0.10f - std::abs(model.mesh.vertices[i].y()));
    if (rim < 0.005f || rim > 0.04f) {
      EXPECT_EQ(found[i], rim < 0.005f ? kFused : (Color{0, 255, 0})) << rim;
    }
  }
}

TEST(BestViewColors, WhereSomethingElseIsInViewAreNotTaken) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  BestViewColors colors(kPlateSurface, model, 4);
  LiveView live = See(model, 0, kGreen);
  const int middle = live.labels.cols / 2;
  live.labels.colRange(0, middle).setTo(kPlateSurface + 1);
  Add(0, live, &colors);
  const auto found = colors.Colors();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float x = model.mesh.vertices[i].x();
    if (std::abs(x) < 0.01f || std::abs(x) > 0.11f) continue;
    if (std::abs(model.mesh.vertices[i].y()) > 0.06f) continue;
    EXPECT_EQ(found[i], x < 0 ? kFused : (Color{0, 255, 0})) << x;
  }
}

TEST(BestViewColors, WhatComesIntoTheImageIsTakenFromTheNextFrameOn) {
  SurfaceModel model = Plate();
  AddFrame(0, MakeMotion({0, 0, 0}, {3, 0, 0}), &model);
  AddFrame(1, Away(0), &model);
  AddFrame(2, Away(0), &model);
  EXPECT_EQ(ColorOf(model, {kBlue, kBlue, kGreen}), (Color{0, 255, 0}));
}

TEST(BestViewColors, CountByTheirFit) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  AddFrame(1, Away(0), &model);
  BestViewColors colors(kPlateSurface, model, 4);
  const PinholeCamera camera = SmallCamera();
  const double sigma = camera.noise.Sigma(1.0);
  Add(0, View(WallDepth(camera, 1), kGreen), &colors);
  Add(1, View(WallDepth(camera, 1 + 1.5 * sigma), kBlue), &colors);
  const double share = std::exp(-1.5 * 1.5 / 2);
  EXPECT_NEAR(colors.Colors()[Middle(model)][2], 255 * share / (1 + share), 4);
}

TEST(BestViewColors, WhatFacesAwayIsNotSeen) {
  SurfaceModel model = Plate();
  AddFrame(0, Turned(180), &model);
  EXPECT_EQ(ColorOf(model, {kGreen}), kFused);
}

TEST(BestViewColors, DrawsWhatHadBeenSeen) {
  SurfaceModel model = Plate();
  AddFrame(0, Away(0), &model);
  BestViewColors colors(kPlateSurface, model, 4);
  Raster raster;
  raster.Clear(SmallCamera());
  colors.Place(0);
  EXPECT_EQ(colors.Draw(SmallCamera(), 7, &raster),
            static_cast<int>(model.mesh.triangles.size()));
  double first = 0, last = 0;
  cv::minMaxLoc(raster.triangle, nullptr, &last);
  cv::minMaxLoc(raster.triangle, &first, nullptr, nullptr, nullptr,
                raster.triangle >= 0);
  EXPECT_GE(first, 7);
  EXPECT_LT(last, 7 + model.mesh.triangles.size());
  // It has no motions of this one.
  colors.Place(5);
  EXPECT_EQ(colors.Draw(SmallCamera(), 7, &raster), 0);
}

TEST(BestViewColors, DoNotDependOnTheNumberOfThreads) {
  SurfaceModel model = Plate(0.005);
  std::vector<std::vector<Color>> found;
  for (int f = 0; f < 5; ++f) AddFrame(f, Turned(10 * f), &model);
  for (const int threads : {1, 4}) {
    const tbb::global_control limit(
        tbb::global_control::max_allowed_parallelism, threads);
    BestViewColors colors(kPlateSurface, model, 4);
    for (int f = 0; f < 5; ++f) {
      Add(f, See(model, f, cv::Vec3b(40 * f, 200 - 40 * f, 99)), &colors);
    }
    found.push_back(colors.Colors());
  }
  EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace splitfusion
