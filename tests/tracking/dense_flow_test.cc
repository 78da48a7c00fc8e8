#include "splitfusion/lib/tracking/dense_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace splitfusion {
namespace {

const cv::Size kSize(160, 120);
const cv::Rect kAll({}, kSize);

/// A random pattern that has moved.
cv::Mat_<std::uint8_t> Pattern(const cv::Point2f& way) {
  cv::Mat_<std::uint8_t> image(kSize);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(image, image, cv::Size(), 2);
  cv::normalize(image, image, 0, 255, cv::NORM_MINMAX);
  const cv::Matx23f shift(1, 0, way.x, 0, 1, way.y);
  cv::warpAffine(image, image, shift, kSize, cv::INTER_LINEAR,
                 cv::BORDER_REFLECT);
  return image;
}

/// A plaid that repeats after 24 pixels and moves along a row.
cv::Mat_<std::uint8_t> Plaid(double way) {
  cv::Mat_<std::uint8_t> image(kSize);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double waves =
          std::sin(2 * M_PI * (u - way) / 24) + std::sin(2 * M_PI * v / 24);
      image(v, u) = static_cast<std::uint8_t>(127 + 60 * waves);
    }
  }
  return image;
}

cv::Mat_<cv::Vec2f> Everywhere(const cv::Vec2f& step) {
  return cv::Mat_<cv::Vec2f>(kSize, step);
}

TEST(DenseFlow, LeadsWhereThePixelsAre) {
  const DenseFlow flow(Pattern({0, 0}), Pattern({4.5f, -3}), kAll,
                       Everywhere({0, 0}));
  for (const cv::Point2f& pixel :
       {cv::Point2f(80, 60), cv::Point2f(40.3f, 30.8f)}) {
    const auto end = flow.Follow(pixel, 1);
    ASSERT_TRUE(end);
    EXPECT_LT(cv::norm(*end - pixel - cv::Point2f(4.5f, -3)), 0.2);
  }
}

TEST(DenseFlow, OfAPartIsInPixelsOfTheWhole) {
  const cv::Rect part(50, 40, 70, 60);
  const DenseFlow flow(Pattern({0, 0}), Pattern({2, 1}), part,
                       Everywhere({0, 0}));
  const cv::Point2f pixel(90, 70);
  ASSERT_TRUE(flow.Follow(pixel, 1));
  EXPECT_LT(cv::norm(*flow.Follow(pixel, 1) - pixel - cv::Point2f(2, 1)), 0.2);
  EXPECT_FALSE(flow.Follow({49, 70}, 1));
  EXPECT_FALSE(flow.Follow({90, 100}, 1));
  cv::Mat_<cv::Vec2f> whole = Everywhere({0, 0});
  flow.Write(&whole);
  EXPECT_LT(cv::norm(whole(70, 90) - cv::Vec2f(2, 1)), 0.2);
  EXPECT_EQ(whole(70, 49), cv::Vec2f(0, 0));
}

TEST(DenseFlow, GoesOnAsBeforeWhereAllLooksAlike) {
  // By 20 of 24 pixels: the nearest one that looks alike is 4 pixels back.
  const auto way = [&](float before) {
    const DenseFlow flow(Plaid(0), Plaid(20), kAll, Everywhere({before, 0}));
    const auto end = flow.Follow({80, 60}, 1);
    return end ? end->x - 80 : NAN;
  };
  EXPECT_NEAR(way(0), -4, 1);
  EXPECT_NEAR(way(17), 20, 1);
}

TEST(DenseFlow, EndsWhereItDoesNotReturn) {
  cv::Mat_<std::uint8_t> other;
  cv::flip(Pattern({0, 0}), other, 0);
  const DenseFlow flow(Pattern({0, 0}), other, kAll, Everywhere({0, 0}));
  int followed = 0;
  for (int v = 2; v < kSize.height; v += 4) {
    for (int u = 2; u < kSize.width; u += 4) {
      const cv::Point2f pixel(static_cast<float>(u), static_cast<float>(v));
      followed += flow.Follow(pixel, 0.5).has_value();
    }
  }
  EXPECT_LT(followed, 30 * 40 / 2);  // By chance.
}

}  // namespace
}  // namespace splitfusion
