#include "splitfusion/lib/report/pictures.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/frame_pictures.h"
#include "splitfusion/lib/report/montage.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using cv::Vec3b;

cv::Mat Depth(float left, float right) {
  return (cv::Mat_<float>(1, 2) << left, right);
}

TEST(NormalPicture, FacingTheCameraIsBlueAndUpIsGreen) {
  cv::Mat_<cv::Vec3f> normals(1, 4);
  normals(0, 0) = {0, 0, -1};  // Towards the camera.
  normals(0, 1) = {0, -1, 0};  // Up: y points down.
  normals(0, 2) = {1, 0, 0};   // To the right.
  normals(0, 3) = {0, 0, 0};   // Unknown.
  const cv::Mat_<Vec3b> picture = NormalPicture(normals);
  EXPECT_EQ(picture(0, 0), Vec3b(255, 128, 128));
  EXPECT_EQ(picture(0, 1), Vec3b(128, 255, 128));
  EXPECT_EQ(picture(0, 2), Vec3b(128, 128, 255));
  EXPECT_EQ(picture(0, 3), Vec3b(255, 255, 255));
}

TEST(DepthPicture, HasAFixedRange) {
  const cv::Mat_<Vec3b> picture = DepthPicture(Depth(0, 9));
  EXPECT_EQ(picture(0, 0), Vec3b(0, 0, 0));  // No measurement.
  const cv::Mat_<Vec3b> at_end = DepthPicture(Depth(5, 0.4f));
  EXPECT_EQ(picture(0, 1), at_end(0, 0));  // Beyond = the end of the range.
  EXPECT_GT(at_end(0, 0)[2], at_end(0, 0)[0]);  // Far is red.
}

TEST(ErrorPicture, GrowsWithTheDistanceOfBothSigns) {
  const cv::Mat_<Vec3b> picture =
      ErrorPicture(Depth(1.05f, 1.0f), Depth(1.0f, 1.05f));
  EXPECT_EQ(picture(0, 0), picture(0, 1));
  EXPECT_GT(picture(0, 0)[2], picture(0, 0)[0]);
  const cv::Mat_<Vec3b> none = ErrorPicture(Depth(0, 1), Depth(1, 1));
  EXPECT_EQ(none(0, 0), Vec3b(0, 0, 0));
  EXPECT_NE(none(0, 1), Vec3b(0, 0, 0));  // Zero error is a colour.
  EXPECT_THROW(ErrorPicture(cv::Mat::ones(2, 2, CV_32F), Depth(1, 1)),
               InputError);
}

TEST(LabelPicture, BlendsSurfacesAndLeavesTheBackground) {
  const cv::Mat color(3, 4, CV_8UC3, cv::Scalar(10, 20, 30));
  cv::Mat labels = cv::Mat::zeros(3, 4, CV_16UC1);
  labels.colRange(0, 3).setTo(2);
  const cv::Mat_<Vec3b> picture = LabelPicture(color, labels);
  EXPECT_EQ(picture(0, 3), Vec3b(10, 20, 30));
  EXPECT_EQ(picture(0, 2), LabelColor(2));  // Outline.
  const Vec3b inside = picture(0, 0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(inside[c], (color.at<Vec3b>(0, 0)[c] + LabelColor(2)[c]) / 2.0,
                1);
  }
}

TEST(LabelColor, TellsManySurfacesApart) {
  for (int a = 0; a < 12; ++a) {
    for (int b = a + 1; b < 12; ++b) {
      EXPECT_GT(cv::norm(LabelColor(a), LabelColor(b)), 25) << a << " " << b;
    }
  }
}

TEST(CompositePicture, IsWhiteWhereNoModelIs) {
  const cv::Mat color(1, 2, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat_<Vec3b> picture = CompositePicture(color, Depth(0, 2));
  EXPECT_EQ(picture(0, 0), Vec3b(255, 255, 255));
  EXPECT_EQ(picture(0, 1), Vec3b(1, 2, 3));
}

TEST(MakeMontage, PlacesTilesInRowsUnderTheirCaptions) {
  std::vector<MontageTile> tiles;
  for (int i = 0; i < 3; ++i) {
    tiles.push_back({"", cv::Mat(40, 60, CV_8UC3, cv::Scalar::all(50 * i))});
  }
  tiles[2].picture = cv::Mat(80, 120, CV_8UC3, cv::Scalar::all(100));
  const cv::Mat_<Vec3b> sheet = MakeMontage(tiles, 2);
  EXPECT_EQ(sheet.cols, 2 * 60 + 4);
  EXPECT_EQ(sheet.rows, 2 * (40 + kCaptionHeight) + 4);
  EXPECT_EQ(sheet(kCaptionHeight, 0), Vec3b::all(0));
  EXPECT_EQ(sheet(kCaptionHeight, 64), Vec3b::all(50));
  EXPECT_EQ(sheet(sheet.rows - 1, 59), Vec3b::all(100));  // Shrunk to size.
  EXPECT_EQ(sheet(sheet.rows - 1, 64), Vec3b::all(255));  // No fourth tile.
  EXPECT_THROW(MakeMontage({}, 2), InputError);
}

TEST(WriteFramePictures, WritesWhatTheImagesAllow) {
  const TemporaryFolder folder;
  const RunPaths paths(folder.Make("run"));
  FrameImages images;
  images.color = cv::Mat(24, 32, CV_8UC3, cv::Scalar(10, 20, 30));
  images.depth = cv::Mat(24, 32, CV_32FC1, cv::Scalar(1.5));
  images.model_depth = images.depth.clone();
  WriteFramePictures(paths, 7, images);
  for (const char* name : {"input", "depth", "error", "montage"}) {
    EXPECT_FALSE(cv::imread(paths.Picture(7, name)).empty()) << name;
  }
  for (const char* name : {"labels", "composite", "normals"}) {
    EXPECT_TRUE(cv::imread(paths.Picture(7, name)).empty()) << name;
  }
}

TEST(WriteMask, KeepsSurfaceIds) {
  const TemporaryFolder folder;
  const RunPaths paths(folder.Make("run"));
  const cv::Mat labels(2, 3, CV_16UC1, cv::Scalar(300));
  WriteMask(paths, "12.5", labels);
  const cv::Mat read = cv::imread(paths.Mask("12.5"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_16UC1);
  EXPECT_EQ(cv::countNonZero(read != labels), 0);
  EXPECT_THROW(WriteMask(paths, "x", cv::Mat::zeros(2, 2, CV_8U)), InputError);
}

TEST(Pictures, RefuseOtherTypesAndSayWhatTheyExpected) {
  try {
    LabelPicture(cv::Mat(2, 3, CV_8UC3), cv::Mat(2, 4, CV_16UC1));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "picture: labels is 4x2 CV_16UC1; expected 3x2 CV_16UC1");
  }
  EXPECT_THROW(NormalPicture(cv::Mat(2, 2, CV_8UC3)), InputError);
  EXPECT_THROW(DepthPicture(cv::Mat(2, 2, CV_16UC1)), InputError);
  EXPECT_THROW(CompositePicture(cv::Mat(2, 2, CV_8UC3), cv::Mat()), InputError);
}

}  // namespace
}  // namespace splitfusion
