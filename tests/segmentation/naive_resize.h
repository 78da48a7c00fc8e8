#ifndef SPLITFUSION_TESTS_SEGMENTATION_NAIVE_RESIZE_H_
#define SPLITFUSION_TESTS_SEGMENTATION_NAIVE_RESIZE_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace splitfusion {

/// Bilinear value of an image at a continuous place, (0.5, 0.5) being the
/// centre of its first pixel; the border goes on for ever.
inline double NaiveSample(const cv::Mat_<float>& image, double x, double y) {
  const auto at = [&](int column, int row) {
    return static_cast<double>(image(std::clamp(row, 0, image.rows - 1),
                                     std::clamp(column, 0, image.cols - 1)));
  };
  const int column = static_cast<int>(std::floor(x - 0.5));
  const int row = static_cast<int>(std::floor(y - 0.5));
  const double u = x - 0.5 - column;
  const double v = y - 0.5 - row;
  return (1 - v) * ((1 - u) * at(column, row) + u * at(column + 1, row)) +
         v * ((1 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
}

/// Bilinear resizing, one pixel at a time.
inline cv::Mat_<float> NaiveResize(const cv::Mat_<float>& image,
                                   cv::Size size) {
  cv::Mat_<float> resized(size);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      resized(row, column) = static_cast<float>(
          NaiveSample(image, (column + 0.5) * image.cols / size.width,
                      (row + 0.5) * image.rows / size.height));
    }
  }
  return resized;
}

/// Expects a mask to be 255 where `probability` is above 0.5 and else 0, but
/// for pixels that are too close to call.
inline void ExpectMaskOf(const cv::Mat_<float>& probability,
                         const cv::Mat& mask) {
  ASSERT_EQ(mask.size(), probability.size());
  ASSERT_EQ(mask.type(), CV_8UC1);
  int inside = 0;
  for (int row = 0; row < mask.rows; ++row) {
    for (int column = 0; column < mask.cols; ++column) {
      const float p = probability(row, column);
      if (std::abs(p - 0.5f) < 1e-4f) continue;
      inside += p > 0.5f;
      ASSERT_EQ(mask.at<uchar>(row, column), p > 0.5f ? 255 : 0)
          << "row " << row << ", column " << column << ", p = " << p;
    }
  }
  EXPECT_GT(inside, 0);
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SEGMENTATION_NAIVE_RESIZE_H_
