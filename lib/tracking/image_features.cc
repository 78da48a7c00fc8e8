#include "splitfusion/lib/tracking/image_features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

namespace splitfusion {
namespace {

/// Least contrast of a feature, of a grey range of 1.
constexpr double kContrast = 0.02;

/// For every row of `cosines` the column that is best by far; -1: none.
std::vector<int> BestColumns(const cv::Mat_<float>& cosines,
                             const Likeness& likeness) {
  std::vector<int> best(cosines.rows, -1);
  for (int row = 0; row < cosines.rows; ++row) {
    float first = -1, second = -1;
    for (int column = 0; column < cosines.cols; ++column) {
      const float cosine = cosines(row, column);
      if (cosine > first) {
        second = first, first = cosine, best[row] = column;
      } else if (cosine > second) {
        second = cosine;
      }
    }
    const float away = std::acos(std::min(1.0f, first));
    if (first < likeness.cosine ||
        !(away <= likeness.ratio * std::acos(std::min(1.0f, second)))) {
      best[row] = -1;
    }
  }
  return best;
}

}  // namespace

ImageFeatures SiftFeatures(const cv::Mat_<std::uint8_t>& grey,
                           const cv::Rect& box,
                           const cv::Mat_<std::uint8_t>& mask, int most) {
  ImageFeatures found;
  std::vector<cv::KeyPoint> points;
  cv::SIFT::create(most, 3, kContrast)
      ->detectAndCompute(grey(box), mask(box), points, found.descriptors);
  for (const cv::KeyPoint& point : points) {
    found.pixels.emplace_back(point.pt.x + box.x, point.pt.y + box.y);
  }
  for (int row = 0; row < found.descriptors.rows; ++row) {
    cv::Mat descriptor = found.descriptors.row(row);
    cv::sqrt(descriptor / std::max(1.0, cv::norm(descriptor, cv::NORM_L1)),
             descriptor);
  }
  return found;
}

ImageFeatures FeaturesWithin(const ImageFeatures& features,
                             const cv::Mat_<std::uint8_t>& mask) {
  ImageFeatures within;
  const cv::Rect image({}, mask.size());
  for (std::size_t i = 0; i < features.pixels.size(); ++i) {
    const cv::Point pixel(cvRound(features.pixels[i][0]),
                          cvRound(features.pixels[i][1]));
    if (!image.contains(pixel) || mask(pixel) == 0) continue;
    within.pixels.push_back(features.pixels[i]);
    within.descriptors.push_back(features.descriptors.row(static_cast<int>(i)));
  }
  return within;
}

std::vector<std::pair<int, int>> AlikeFeatures(const ImageFeatures& before,
                                               const ImageFeatures& now,
                                               const Likeness& likeness) {
  std::vector<std::pair<int, int>> alike;
  if (before.pixels.empty() || now.pixels.empty()) return alike;
  cv::Mat_<float> cosines = before.descriptors * now.descriptors.t();
  for (int i = 0; i < cosines.rows; ++i) {
    for (int j = 0; j < cosines.cols; ++j) {
      if (cv::norm(before.pixels[i] - now.pixels[j]) > likeness.reach) {
        cosines(i, j) = -1;
      }
    }
  }
  const std::vector<int> forth = BestColumns(cosines, likeness);
  const std::vector<int> back = BestColumns(cosines.t(), likeness);
  for (std::size_t i = 0; i < forth.size(); ++i) {
    const int row = static_cast<int>(i);
    if (forth[i] >= 0 && back[forth[i]] == row) {
      alike.emplace_back(row, forth[i]);
    }
  }
  return alike;
}

}  // namespace splitfusion
