#include "splitfusion/lib/segmentation/input_placement.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "segmentation/naive_resize.h"

namespace splitfusion {
namespace {

TEST(InputPlacement, LetterboxKeepsTheAspectInTheMiddle) {
  EXPECT_EQ(Letterbox({640, 480}, {640, 480}).content,
            cv::Rect(0, 0, 640, 480));
  EXPECT_EQ(Letterbox({640, 480}, {640, 640}).content,
            cv::Rect(0, 80, 640, 480));
  EXPECT_EQ(Letterbox({1280, 720}, {640, 480}).content,
            cv::Rect(0, 60, 640, 360));
  EXPECT_EQ(Letterbox({240, 480}, {640, 480}).content,
            cv::Rect(200, 0, 240, 480));
  // An odd margin of 7 rows: 3 above, 4 below, as YOLOv8 has it.
  EXPECT_EQ(Letterbox({64, 57}, {64, 64}).content, cv::Rect(0, 3, 64, 57));
  EXPECT_EQ(Letterbox({4000, 1}, {64, 64}).content.height, 1);
}

TEST(InputPlacement, BoxesGoBackToTheFrameAndAreClipped) {
  const InputPlacement placement = Letterbox({1280, 720}, {640, 480});
  EXPECT_EQ(placement.FrameBox({10, 70, 100, 50}),
            cv::Rect2d(20, 20, 200, 100));
  EXPECT_EQ(placement.FrameBox({-10, 0, 20, 480}), cv::Rect2d(0, 0, 20, 720));
  EXPECT_TRUE(placement.FrameBox({0, 0, 640, 60}).empty());
  EXPECT_EQ(Stretch({640, 480}, {550, 550}).FrameBox({0, 0, 275, 275}),
            cv::Rect2d(0, 0, 320, 240));
}

TEST(InputPlacement, FillsAroundTheFrame) {
  const cv::Mat color(8, 16, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat input =
      PlaceFrame(color, Letterbox({16, 8}, {16, 16}), cv::Scalar::all(114));
  ASSERT_EQ(input.size(), cv::Size(16, 16));
  EXPECT_EQ(input.at<cv::Vec3b>(3, 5), cv::Vec3b(114, 114, 114));
  EXPECT_EQ(input.at<cv::Vec3b>(4, 5), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(input.at<cv::Vec3b>(11, 15), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(input.at<cv::Vec3b>(12, 0), cv::Vec3b(114, 114, 114));
}

TEST(InputPlacement, MasksAreInterpolatedInTheFrame) {
  cv::Mat_<float> probability(12, 16);
  cv::randu(probability, 0.0, 1.0);
  // Nothing around the frame: prototypes straight to the frame.
  ExpectMaskOf(NaiveResize(probability, {100, 70}),
               FrameMask(probability, Stretch({100, 70}, {64, 48})));
  // A margin: prototypes to the input, its content to the frame.
  const InputPlacement placement = Letterbox({100, 50}, {64, 48});
  ASSERT_EQ(placement.content, cv::Rect(0, 8, 64, 32));
  const cv::Mat_<float> input = NaiveResize(probability, {64, 48});
  ExpectMaskOf(NaiveResize(input(placement.content).clone(), {100, 50}),
               FrameMask(probability, placement));
}

TEST(InputPlacement, ABoxHoldsThePixelsWhoseCentreIsInside) {
  cv::Mat mask(10, 10, CV_8UC1, cv::Scalar(255));
  ClearOutside({1.4, 2.6, 3.2, 100}, &mask);
  EXPECT_EQ(cv::boundingRect(mask), cv::Rect(1, 3, 4, 7));
  ClearOutside({}, &mask);
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

}  // namespace
}  // namespace splitfusion
