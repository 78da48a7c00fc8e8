#include "splitfusion/lib/render/depth_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/plate_views.h"
#include "splitfusion/lib/base/hdf5_file.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Residuals of the plate in its only frame, where live depth is `off` behind
/// it; `mask`: pixels that something else has.
DepthResiduals ResidualsAt(float off, const cv::Rect& other = {}) {
  SurfaceModel model = Plate();
  AddFrame(7, Away(0), &model);
  LiveView live = See(model, 0, {0, 0, 0});
  live.depth += off;
  if (!other.empty()) live.labels(other).setTo(kPlateSurface + 1);
  BestViewColors placed(kPlateSurface, model, 4);
  placed.Place(7);
  Raster raster;
  raster.Clear(live.camera);
  placed.Draw(live.camera, 0, &raster);
  DepthResiduals residuals;
  AddDepthResiduals(placed, live, raster, &residuals);
  return residuals;
}

TEST(DepthResiduals, AreTheDistanceAlongTheOpticalAxis) {
  for (const float off : {0.0f, 0.02f, -0.02f}) {
    const DepthResiduals residuals = ResidualsAt(off);
    ASSERT_FALSE(residuals.empty());
    for (const DepthResidual& one : residuals) {
      EXPECT_EQ(one.frame, 7);
      EXPECT_NEAR(one.depth, std::abs(off), 2e-3);
    }
  }
}

TEST(DepthResiduals, WhatIsHiddenHasNoneAndWhatIsGoneThatOfTheTolerance) {
  EXPECT_TRUE(ResidualsAt(-0.5).empty());
  const DepthResiduals gone = ResidualsAt(0.8);
  ASSERT_FALSE(gone.empty());
  for (const DepthResidual& one : gone) {
    EXPECT_GT(one.depth, 0.1);
    EXPECT_LT(one.depth, 0.2);
  }
  const PinholeCamera camera = SmallCamera();
  EXPECT_TRUE(
      ResidualsAt(0, cv::Rect(0, 0, camera.width, camera.height)).empty());
}

TEST(DepthResiduals, AreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const DepthResiduals residuals = {{3, 1, 0.5f}, {3, 2, 0.25f}, {4, 1, 0}};
  WriteResiduals(folder / "residuals.h5", residuals);
  const DepthResiduals read = ReadResiduals(folder / "residuals.h5");
  ASSERT_EQ(read.size(), residuals.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].frame, residuals[i].frame);
    EXPECT_EQ(read[i].node, residuals[i].node);
    EXPECT_EQ(read[i].depth, residuals[i].depth);
  }
  EXPECT_TRUE(ReadResiduals(folder / "none.h5").empty());
  folder.Write("broken.h5", "no HDF5");
  ExpectInputError([&] { ReadResiduals(folder / "broken.h5"); }, "broken.h5");
}

TEST(DepthResiduals, OfANewerVersionAreRefused) {
  const TemporaryFolder folder;
  const auto write = [&](std::optional<std::int32_t> version) {
    Hdf5Writer file(folder / "residuals.h5");
    std::vector<std::int32_t> rows = {1};
    std::vector<float> depths = {2};
    if (version) file.Attribute("format_version", &*version);
    file.Column("residuals/frame", &rows);
    file.Column("residuals/node", &rows);
    file.Column("residuals/depth", &depths);
    file.Close();
  };
  // Files of the time before there were versions have none.
  for (const auto version :
       std::vector<std::optional<std::int32_t>>{{}, 0, 1}) {
    write(version);
    EXPECT_EQ(ReadResiduals(folder / "residuals.h5").size(), 1u);
  }
  for (const std::int32_t version : {2, -1}) {
    write(version);
    ExpectInputError(
        [&] { ReadResiduals(folder / "residuals.h5"); },
        "residuals.h5: field 'format_version': " + std::to_string(version) +
            ": expected at most 1; a file of a newer version "
            "needs its programs");
  }
}

}  // namespace
}  // namespace splitfusion
