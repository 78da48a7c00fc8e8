#include "splitfusion/lib/tracking/image_shift.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

const PinholeCamera kCamera{320, 240, 260, 260, 160, 120};

/// A live view with one tall body at `body` before a wall at 3 m.
LiveView ViewOf(const cv::Rect& body, float depth) {
  cv::Mat_<float> image(240, 320, 3.0f);
  image(body & cv::Rect(0, 0, 320, 240)) = depth;
  LiveView live = MakeLiveView(kCamera, image,
                               cv::Mat(240, 320, CV_8UC3, cv::Scalar(1, 2, 3)));
  live.labels(body & cv::Rect(0, 0, 320, 240)) = 1;
  return live;
}

/// Depth of a model at `body`, every second pixel.
cv::Mat_<float> ModelOf(const cv::Rect& body, float depth) {
  cv::Mat_<float> model(120, 160, 0.0f);
  model(cv::Rect(body.x / 2, body.y / 2, body.width / 2, body.height / 2)) =
      depth;
  return model;
}

TEST(FindImageShift, FindsAFarJump) {
  const auto shift = FindImageShift(ModelOf({40, 64, 48, 112}, 2.0f),
                                    ViewOf({200, 72, 48, 112}, 2.24f), 1);
  ASSERT_TRUE(shift);
  // Pixels to metres at 2.24 m.
  EXPECT_NEAR(shift->translation().x(), 160 * 2.24 / 260, 0.08);
  EXPECT_NEAR(shift->translation().y(), 8 * 2.24 / 260, 0.08);
  EXPECT_NEAR(shift->translation().z(), 0.24, 0.09);
}

TEST(FindImageShift, AHalfHiddenBodyIsNotPulledToItsCentroid) {
  LiveView live = ViewOf({120, 64, 48, 112}, 2.0f);
  const cv::Rect hiding(120, 64, 48, 56);
  live.labels(hiding) = 2;
  live.depth(hiding) = 1.5f;
  const auto shift = FindImageShift(ModelOf({96, 64, 48, 112}, 2.0f), live, 1);
  ASSERT_TRUE(shift);
  EXPECT_NEAR(shift->translation().x(), 24 * 2.0 / 260, 0.07);
  // The centroid of what is seen is 28 pixels lower: 0.22 m.
  EXPECT_NEAR(shift->translation().y(), 0, 0.07);
}

TEST(FindImageShift, SaysWhenNothingFits) {
  const LiveView live = ViewOf({120, 64, 48, 112}, 2.0f);
  EXPECT_FALSE(FindImageShift(ModelOf({96, 64, 48, 112}, 0.5f), live, 1));
  EXPECT_FALSE(FindImageShift(ModelOf({96, 64, 0, 0}, 2.0f), live, 1));
  EXPECT_FALSE(FindImageShift(ModelOf({96, 64, 48, 112}, 2.0f), live, 7));
}

}  // namespace
}  // namespace splitfusion
