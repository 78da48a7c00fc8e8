#include "splitfusion/lib/report/detection_picture.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/report/pictures.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

InstanceMask MakeInstance(const cv::Rect& inside) {
  InstanceMask instance{cv::Mat(120, 160, CV_8UC1, cv::Scalar(0)), "dog", 0.5};
  instance.mask(inside) = 255;
  return instance;
}

/// 55 % of grey 100 and 45 % of the label's colour.
cv::Vec3b Blended(int label) {
  cv::Vec3b color = LabelColor(label);
  for (int c = 0; c < 3; ++c) {
    color[c] = cv::saturate_cast<uchar>(0.55 * 100 + 0.45 * color[c]);
  }
  return color;
}

TEST(DetectionPicture, PaintsInstancesAndLeavesTheRest) {
  const cv::Mat color(120, 160, CV_8UC3, cv::Scalar::all(100));
  const cv::Mat picture = DetectionPicture(
      color, {MakeInstance({10, 10, 40, 100}), MakeInstance({90, 50, 60, 60})});
  ASSERT_EQ(picture.size(), color.size());
  EXPECT_EQ(picture.at<cv::Vec3b>(60, 30), Blended(1));
  EXPECT_EQ(picture.at<cv::Vec3b>(90, 120), Blended(2));
  EXPECT_EQ(picture.at<cv::Vec3b>(60, 10), LabelColor(1));  // Its outline.
  EXPECT_EQ(picture.at<cv::Vec3b>(5, 5), cv::Vec3b(100, 100, 100));
  EXPECT_EQ(color.at<cv::Vec3b>(60, 30), cv::Vec3b(100, 100, 100));
}

TEST(DetectionPicture, RefusesMasksOfAnotherSize) {
  ExpectInputError(
      [] {
        DetectionPicture(cv::Mat(12, 16, CV_8UC3),
                         {MakeInstance({0, 0, 1, 1})});
      },
      "mask of 160x120; expected 16x12");
}

}  // namespace
}  // namespace splitfusion
