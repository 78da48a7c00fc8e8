// The program sf_convert, as others call it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_refused.h"
#include "support/program.h"
#include "support/temporary_folder.h"
#include "support/two_cameras.h"

namespace splitfusion {
namespace {

using ::testing::HasSubstr;

/// Three frames in the layout of ScanNet; colour of twice the size, from a
/// camera beside.
class SfConvert : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasProgram("sf_convert")) GTEST_SKIP() << "sf_convert is not built";
    color_camera_ = BoardsColorCamera();
    color_camera_.width = 640;
    color_camera_.height = 480;
    color_camera_.fx *= 2;
    color_camera_.fy *= 2;
    color_camera_.cx = 319.5;
    color_camera_.cy = 239.5;
    color_camera_.color_from_depth = Eigen::Translation3d(-0.025, 0, 0);
    for (const char* name : {"color", "depth", "pose", "intrinsic"}) {
      folder_.Make(std::string("scene/") + name);
    }
    for (int i = 0; i < 3; ++i) WriteFrame(i);
    WriteMatrix("intrinsic/intrinsic_depth", 290, 159.5, 119.5, 0);
    WriteMatrix("intrinsic/intrinsic_color", color_camera_.fx, 319.5, 239.5, 0);
    WriteMatrix("intrinsic/extrinsic_color", 1, 0, 0, 0.025);
  }

  void WriteFrame(int i) {
    const std::string n = std::to_string(i);
    const Frame frame = BoardsFrame(i, camera_, color_camera_);
    cv::imwrite(folder_ / ("scene/color/" + n + ".png"), frame.color);
    cv::Mat depth;
    frame.depth.convertTo(depth, CV_16U, 1000);
    cv::imwrite(folder_ / ("scene/depth/" + n + ".png"), depth);
    if (i != 1) WriteMatrix("pose/" + n, 1, 0, 0, 0.125 * i);
  }
  void WriteMatrix(const std::string& name, double f, double cx, double cy,
                   double x) {
    const auto text = [](double value) { return std::to_string(value) + " "; };
    folder_.Write("scene/" + name + ".txt",
                  text(f) + "0 " + text(cx) + text(x) + "\n0 " + text(f) +
                      text(cy) + "0\n0 0 1 0\n0 0 0 1\n");
  }
  ProgramResult Convert(const std::string& from, const std::string& to,
                        const std::string& more = "") {
    return RunProgram("sf_convert", "--sequence=" + (folder_ / from) +
                                        " --output=" + (folder_ / to) + " " +
                                        more);
  }

  TemporaryFolder folder_;
  PinholeCamera camera_ = BoardsCamera();
  ColorCamera color_camera_;
};

TEST_F(SfConvert, WritesARegisteredSequenceWithItsPoses) {
  const ProgramResult result = Convert("scene", "tum");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("3 frames of 320x240, 2 with a pose"));
  ImageFolderReader reader(folder_ / "tum");
  EXPECT_EQ(reader.options().format, "tum");
  EXPECT_EQ(reader.camera().fx, 290);
  EXPECT_FALSE(reader.calibration().color);
  ASSERT_EQ(reader.size(), 3);
  for (int i = 0; i < 3; ++i) {
    const Frame truth =
        BoardsFrame(i, camera_, ColorCamera::Registered(camera_));
    EXPECT_EQ(reader.Stem(i), std::to_string(i));
    EXPECT_NEAR(reader.pairs()[i].depth.timestamp, i / 30.0, 1e-6);
    EXPECT_LT(cv::norm(reader.ReadDepth(i), truth.depth, cv::NORM_INF), 6e-4);
    cv::Mat difference;
    cv::absdiff(reader.ReadColor(i), truth.color, difference);
    cv::extractChannel(difference, difference, 0);
    EXPECT_LT(cv::countNonZero(difference > 5), 2500) << "edges, and hidden";
  }
  const Trajectory poses = reader.FindSequencePoses();
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_DOUBLE_EQ(poses[1].world_from_camera.translation().x(), 0.25);
}

TEST_F(SfConvert, WhatIsConvertedAgainStaysTheSame) {
  ASSERT_EQ(Convert("scene", "a").exit_code, 0);
  ASSERT_EQ(Convert("a", "b", "--color_camera=none").exit_code, 0);
  for (const char* file :
       {"rgb/1.png", "depth/1.png", "rgb.txt", "depth.txt", "associations.txt",
        "camera.txt", "groundtruth.txt"}) {
    ASSERT_FALSE(folder_.Read(std::string("a/") + file).empty()) << file;
    EXPECT_EQ(folder_.Read(std::string("a/") + file),
              folder_.Read(std::string("b/") + file))
        << file;
  }
}

TEST_F(SfConvert, ChoosesFrames) {
  const ProgramResult result = Convert("scene", "a", "--frame_step=2");
  EXPECT_THAT(result.output, HasSubstr("2 frames of"));
  EXPECT_FALSE(folder_.Has("a/rgb/1.png"));
  EXPECT_TRUE(folder_.Has("a/rgb/2.png"));
}

TEST_F(SfConvert, ABrokenFrameEndsItOrIsLeftOut) {
  folder_.Write("scene/depth/1.png", "no image");
  const std::string start = "--sequence=" + (folder_ / "scene") +
                            " --output=" + (folder_ / "a") + " ";
  ExpectRefused("sf_convert", start, "depth/1.png: 8 bytes that are no image");
  EXPECT_FALSE(folder_.Has("a")) << "nothing is left of it";
  EXPECT_THAT(Convert("scene", "a", "--skip_bad_frames").output,
              HasSubstr("2 frames of"));
  ExpectRefused("sf_convert", start + "--skip_bad_frames", folder_ / "a");
  EXPECT_EQ(Convert("scene", "a", "--skip_bad_frames --overwrite").exit_code,
            0);
}

TEST_F(SfConvert, SaysWhatIsWrong) {
  ExpectRefused("sf_convert", "", "--sequence = '': expected the folder");
  ExpectRefused("sf_convert", "--sequence=" + (folder_ / "scene"),
                "--output = '': expected a folder to write");
  ExpectRefused("sf_convert",
                "--sequence=" + (folder_ / "none") + " --output=x",
                "none: no such folder or file");
  ExpectRefused("sf_convert",
                "--frame_step=0 --output=x --sequence=" + (folder_ / "scene"),
                "--frame_step = 0: expected a number >= 1");
}

}  // namespace
}  // namespace splitfusion
