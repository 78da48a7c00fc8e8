#include "splitfusion/lib/evaluation/depth_agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "support/bent_plate.h"
#include "support/expect_input_error.h"
#include "support/motion_frames.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// A perfect run of the bending plate and the depth images it is of.
class DepthAgreementTest : public ::testing::Test {
 protected:
  using Spoil = std::function<void(RecordedRun*)>;

  DepthAgreementTest() {
    std::filesystem::create_directories(folder_ / "run");
    BentPlate().WriteRun(folder_ / "run");
    BentPlate().WriteSequence(folder_ / "sequence", folder_ / "run");
  }

  /// Agreement of the run after `spoil`; by default of frame 0 alone, in which
  /// plate and wall lie across the optical axis.
  std::vector<DepthAgreement> Compare(const Spoil& spoil = {},
                                      int every = 100) const {
    RecordedRun run = ReadRun(folder_ / "run");
    if (spoil) spoil(&run);
    const auto surfaces = AnimateSurfaces(std::move(run.surfaces));
    return CompareDepth(run, surfaces, every, plain_view_pixels_);
  }

  void ExpectRefused(const std::string& message) const {
    ExpectInputError([&] { Compare(); }, message);
  }

  TemporaryFolder folder_;
  int plain_view_pixels_ = 8000;
};

/// Moves the plate towards the camera of frame 0.
void ShiftPlate(RecordedRun* run, float metres) {
  for (Eigen::Vector3f& vertex : run->surfaces[1].mesh.vertices) {
    vertex.z() -= metres;
  }
}

/// Takes away the triangles of the plate's right half.
void HalvePlate(RecordedRun* run) {
  TriangleMesh& mesh = run->surfaces[1].mesh;
  const auto right = [&](const Eigen::Vector3i& triangle) {
    return mesh.vertices[triangle[0]].x() > 0;
  };
  mesh.triangles.erase(
      std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), right),
      mesh.triangles.end());
}

TEST_F(DepthAgreementTest, PerfectRunAgrees) {
  const auto surfaces = Compare({}, 5);
  ASSERT_EQ(surfaces.size(), 2u);
  EXPECT_EQ(surfaces[0].surface_label, "background");
  EXPECT_EQ(surfaces[1].surface_id, 1);
  for (const DepthAgreement& surface : surfaces) {
    EXPECT_EQ(surface.frames, 3);  // 0, 5 and 10.
    EXPECT_LT(surface.distances.p90, 0.0005);
    EXPECT_LT(surface.UncoveredFraction(), 0.02);
    EXPECT_EQ(surface.pixels, surface.distances.count + surface.uncovered);
  }
  // 52 x 39 pixels, three times, less where it bends.
  EXPECT_NEAR(surfaces[1].pixels, 3 * 52 * 39, 600);
}

TEST_F(DepthAgreementTest, ShiftOfFiveMillimetresIsFiveMillimetres) {
  for (const float shift : {0.005f, -0.005f}) {
    const auto surfaces =
        Compare([&](RecordedRun* run) { ShiftPlate(run, shift); });
    // The images have steps of 0.2 mm, the statistics of 0.1 mm.
    EXPECT_NEAR(surfaces[1].distances.median, 0.005, 0.0002);
    EXPECT_NEAR(surfaces[1].distances.p90, 0.005, 0.0002);
    EXPECT_LT(surfaces[0].distances.median, 0.0002);
  }
}

TEST_F(DepthAgreementTest, HalfAPlateLeavesHalfUncovered) {
  const auto surfaces = Compare(HalvePlate);
  EXPECT_NEAR(surfaces[1].UncoveredFraction(), 0.5, 0.04);
  // There the wall behind it is seen, which is not compared with the plate.
  EXPECT_EQ(surfaces[1].other_surface, surfaces[1].uncovered);
  EXPECT_LT(surfaces[1].distances.max, 0.001);
}

TEST_F(DepthAgreementTest, SurfaceHiddenBehindAnotherOneIsUncovered) {
  const auto surfaces =
      Compare([](RecordedRun* run) { ShiftPlate(run, -0.6f); });
  EXPECT_GT(surfaces[1].UncoveredFraction(), 0.99);
  EXPECT_EQ(surfaces[1].distances.count, 0);
  EXPECT_LT(surfaces[0].UncoveredFraction(), 0.02);
}

TEST_F(DepthAgreementTest, FramesInWhichASurfaceWasNotTrackedDoNotCount) {
  const auto lost_but_once = [](RecordedRun* run) {
    ShiftPlate(run, 0.3f);
    EditFrames([](FrameMotions& frame) { frame.tracked = frame.frame == 5; },
               &run->surfaces[1].motions);
  };
  const auto surfaces = Compare(lost_but_once, 5);
  EXPECT_EQ(surfaces[0].frames, 3);
  EXPECT_EQ(surfaces[1].frames, 1);
  EXPECT_GT(surfaces[1].distances.median, 0.25);
}

TEST_F(DepthAgreementTest, SurfaceInPlainViewThatWasNotTrackedIsUncovered) {
  plain_view_pixels_ = 1000;
  const auto lost_but_once = [](RecordedRun* run) {
    EditFrames([](FrameMotions& frame) { frame.tracked = frame.frame == 5; },
               &run->surfaces[1].motions);
  };
  const auto surfaces = Compare(lost_but_once, 5);
  EXPECT_EQ(surfaces[1].frames, 1);
  EXPECT_EQ(surfaces[1].frames_missing, 2);
  EXPECT_NEAR(surfaces[1].UncoveredFraction(), 2. / 3, 0.02);
}

TEST_F(DepthAgreementTest, DepthOutOfTheRangeOfTheRunDoesNotCount) {
  folder_.Write("run/options.flags",
                "--max_depth=1.2\n--sequence=" + (folder_ / "sequence") + "\n");
  const auto surfaces = Compare();
  EXPECT_EQ(surfaces[0].pixels, 0);  // The wall is at 1.5 m.
  EXPECT_GT(surfaces[1].pixels, 1500);
}

TEST_F(DepthAgreementTest, DepthScaleIsThatOfTheRun) {
  folder_.Write("run/calibration.txt", "130 130 79.5 59.5 160 120 5050\n");
  EXPECT_NEAR(Compare()[1].distances.median, 1 - 5000. / 5050, 0.0002);
  std::filesystem::remove(folder_ / "run/calibration.txt");
  folder_.Write("sequence/calibration.txt", "130 130 79.5 59.5 160 120 1\n");
  folder_.Write("run/options.flags", "--depth_scale=5000\n--sequence=" +
                                         (folder_ / "sequence") + "\n");
  EXPECT_LT(Compare()[1].distances.median, 0.0002);
}

TEST_F(DepthAgreementTest, SaysWhatIsMissing) {
  folder_.Write("run/masks/stem0.png", "no image");
  ExpectRefused("masks/stem0.png");
  cv::imwrite(folder_ / "run/masks/stem0.png", cv::Mat::zeros(2, 3, CV_16U));
  ExpectRefused("stem0.png: 3x2 pixels: expected 160x120");
  const std::string list = folder_.Read("sequence/associations.txt");
  folder_.Write("sequence/associations.txt", list.substr(list.find('\n') + 1));
  ExpectRefused("frame 0 is 'stem1': expected 'stem0'");
  std::filesystem::remove(folder_ / "run/calibration.txt");
  ExpectRefused("no camera intrinsics");
  folder_.Write("run/options.flags", "--sequence=/no/such/folder\n");
  ExpectRefused("/no/such/folder: expected the folder of the sequence");
  folder_.Write("run/options.flags", "--min_depth=near\n");
  ExpectRefused("options.flags: --min_depth=near: expected metres >= 0");
}

}  // namespace
}  // namespace splitfusion
