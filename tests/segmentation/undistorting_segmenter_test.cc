#include "splitfusion/lib/segmentation/undistorting_segmenter.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace splitfusion {
namespace {

/// One mask, whatever the frame shows.
class OneMask : public Segmenter {
 public:
  explicit OneMask(const cv::Mat& mask) : mask_(mask) {}
  std::vector<InstanceMask> Segment(const Frame&) override {
    return {{mask_, "person", 0.5}};
  }

 private:
  cv::Mat mask_;
};

TEST(UndistortingSegmenter, MasksGoWithTheColourImage) {
  const PinholeCamera camera = {320, 240, 260, 260, 159.5, 119.5};
  LensDistortion lens;
  lens.coefficients[0] = 0.4;
  const auto undistortion = std::make_shared<Undistortion>(camera, lens);
  cv::Mat mask = cv::Mat::zeros(240, 320, CV_8UC1);
  cv::rectangle(mask, {40, 30, 60, 50}, 255, cv::FILLED);
  cv::Mat color;
  cv::cvtColor(mask, color, cv::COLOR_GRAY2BGR);
  cv::Mat expected;
  cv::extractChannel(undistortion->Color(color), expected, 0);
  UndistortingSegmenter segmenter(std::make_shared<OneMask>(mask),
                                  undistortion);
  const std::vector<InstanceMask> found = segmenter.Segment({});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].class_name, "person");
  EXPECT_EQ(found[0].score, 0.5);
  cv::Mat is_other = (expected > 127) != found[0].mask;
  EXPECT_LT(cv::countNonZero(is_other), 20) << "half pixels of the border";
  is_other = mask != found[0].mask;
  EXPECT_GT(cv::countNonZero(is_other), 500) << "it has moved";
}

}  // namespace
}  // namespace splitfusion
