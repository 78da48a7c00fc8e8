#include "splitfusion/lib/visibility/exposure.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

/// A surface (id 1) at 2 m over the left half of a 64x48 image.
class ExposureTest : public testing::Test {
 protected:
  ExposureTest() {
    model_ = cv::Mat_<float>::zeros(48 / kStep, 64 / kStep);
    model_.colRange(0, 32 / kStep).setTo(2.f);
    live_.depth = cv::Mat_<float>(48, 64, 3.f);
    live_.labels = cv::Mat_<std::uint16_t>::zeros(48, 64);
  }

  void Show(int columns, float depth, int label) {
    live_.depth.colRange(0, columns).setTo(depth);
    live_.labels.colRange(0, columns).setTo(label);
  }

  double exposure() const { return Exposure(model_, kStep, live_, 1); }

  static constexpr int kStep = 4;
  cv::Mat_<float> model_;
  LiveView live_;
};

TEST_F(ExposureTest, IsOneWithoutAnythingBeforeIt) {
  EXPECT_EQ(exposure(), 1);  // It is gone: the wall is seen behind it.
  Show(16, 2, 1);
  EXPECT_EQ(exposure(), 1);
}

TEST_F(ExposureTest, IsThePartThatNothingNearerHides) {
  Show(32, 2, 1);
  Show(24, 1, 2);
  EXPECT_DOUBLE_EQ(exposure(), 0.25);
  Show(24, 1.95f, 2);  // As near as the surface itself.
  EXPECT_DOUBLE_EQ(exposure(), 1);
  Show(32, 1, 0);
  EXPECT_DOUBLE_EQ(exposure(), 0);
}

TEST_F(ExposureTest, PixelsWithoutDepthDoNotCount) {
  Show(32, 0, 1);
  EXPECT_EQ(exposure(), 1);
}

}  // namespace
}  // namespace splitfusion
