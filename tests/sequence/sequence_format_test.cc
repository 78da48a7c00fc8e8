#include "splitfusion/lib/sequence/sequence_format.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Two frames in the layout of 7-Scenes, 1 and 2 m away.
class SevenScenes : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const int i : {10, 2}) {
      const std::string stem = folder_ / ("frame-0000" + Digits(i));
      cv::imwrite(stem + ".color.png",
                  cv::Mat(480, 640, CV_8UC3, cv::Scalar(i, 20, 30)));
      cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(i == 2 ? 1000 : 2000));
      depth.colRange(0, 100).setTo(65535);
      cv::imwrite(stem + ".depth.png", depth);
    }
    folder_.Write("frame-000002.pose.txt", "1 0 0 0\n");
  }
  static std::string Digits(int i) {
    return (i < 10 ? "0" : "") + std::to_string(i);
  }

  TemporaryFolder folder_;
};

TEST_F(SevenScenes, IsRecognisedAndRead) {
  ImageFolderReader reader(folder_ / "");
  EXPECT_EQ(reader.options().format, "7scenes");
  EXPECT_EQ(reader.camera().fx, 585);
  EXPECT_EQ(reader.camera().cy, 240);
  ASSERT_EQ(reader.size(), 2);
  EXPECT_NO_THROW(reader.CheckFrames());
  for (const int i : {2, 10}) {
    const std::optional<Frame> frame = reader.Next();
    EXPECT_EQ(frame->stem, "frame-0000" + Digits(i) + ".depth");
    EXPECT_EQ(frame->color_stem, "frame-0000" + Digits(i) + ".color");
    EXPECT_DOUBLE_EQ(frame->timestamp, i / 30.0);
    EXPECT_EQ(frame->color.at<cv::Vec3b>(5, 7), cv::Vec3b(i, 20, 30));
    EXPECT_FLOAT_EQ(frame->depth.at<float>(200, 300), i == 2 ? 1 : 2);
    EXPECT_EQ(frame->depth.at<float>(200, 50), 0) << "65535 is no depth";
  }
}

TEST_F(SevenScenes, AFileOrTheOptionsReplaceTheCalibration) {
  folder_.Write("calibration.txt", "500 501 320 240 640 480 2000\n");
  ReaderOptions options;
  options.depth_scale = 500;
  ImageFolderReader reader(folder_ / "", options);
  EXPECT_EQ(reader.camera().fy, 501);
  EXPECT_FLOAT_EQ(reader.Next()->depth.at<float>(200, 300), 2);
}

TEST_F(SevenScenes, AMissingDepthImageIsABadFrame) {
  std::filesystem::remove(folder_ / "frame-000010.depth.png");
  ExpectInputError([&] { ImageFolderReader(folder_ / "").CheckFrames(); },
                   "frame-000010.depth.png: cannot be opened");
}

TEST_F(SevenScenes, AFormatCanBeNamed) {
  folder_.Write("rgb.txt", "");
  EXPECT_EQ(ResolveFormat("auto", folder_ / "", BuiltinFormats()), "tum");
  ReaderOptions options;
  options.format = "7scenes";
  EXPECT_EQ(ImageFolderReader(folder_ / "", options).size(), 2);
  options.format = "kitti";
  ExpectInputError([&] { ImageFolderReader(folder_ / "", options); },
                   "format = kitti: expected bonn, icl_nuim, tum");
}

TEST(SequenceFormat, WhatNoneRecognisesListsThem) {
  const TemporaryFolder folder;
  folder.Write("frame-.color.png", "");
  folder.Write("frame-abcdef.color.png", "");
  ExpectInputError([&] { ImageFolderReader(folder / ""); },
                   folder / "" +
                       ": expected a sequence of a known format, bonn (rgb.txt "
                       "and depth.txt in a folder rgbd_bonn_...), icl_nuim (");
  ExpectInputError([&] { ImageFolderReader(folder / ""); },
                   "7scenes (frame-000000.color.png, frame-000000.depth.png, "
                   "...), scannet (color/, depth/ and ");
  ExpectInputError([&] { ImageFolderReader(folder / ""); },
                   "sens (a file *.sens) or rosbag (a file *.bag of ROS 1)");
  ExpectInputError([&] { ImageFolderReader(folder / "none"); },
                   "no such folder or file");
  ReaderOptions options;
  options.format = "7scenes";
  ExpectInputError([&] { ImageFolderReader(folder / "", options); },
                   "0 frames");
}

}  // namespace
}  // namespace splitfusion
