#include "splitfusion/lib/split/appearance.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace splitfusion {

Appearance ComputeAppearance(const cv::Mat& color, const PointMap& points,
                             const cv::Mat_<uchar>& mask,
                             const Rigid3d& world_from_camera) {
  Appearance appearance;
  const cv::Rect box = cv::boundingRect(mask);
  if (box.area() == 0) return appearance;
  const cv::Mat inside = mask(box);
  const cv::Mat pixels = color(box);
  const int channels[] = {0, 1, 2};
  const int bins[] = {8, 8, 8};
  const float range[] = {0, 256};
  const float* ranges[] = {range, range, range};
  cv::calcHist(&pixels, 1, channels, inside, appearance.histogram, 3, bins,
               ranges);
  appearance.pixels = cv::countNonZero(inside);
  appearance.histogram /= appearance.pixels;
  cv::Mat z;
  cv::extractChannel(points.points(box), z, 2);
  const cv::Mat measured = inside & (z > 0);
  appearance.placed = cv::countNonZero(measured) > 0;
  const cv::Scalar mean = cv::mean(points.points(box), measured);
  appearance.center =
      world_from_camera * Eigen::Vector3d(mean[0], mean[1], mean[2]);
  return appearance;
}

void AddView(const Appearance& view, Appearance* appearance) {
  if (view.identity > 0) appearance->identity = view.identity;
  if (view.histogram.empty()) return;
  if (view.placed) {
    appearance->center = view.center;
    appearance->placed = true;
  }
  if (appearance->histogram.empty()) {
    appearance->histogram = view.histogram.clone();
    appearance->pixels = view.pixels;
    return;
  }
  appearance->pixels += view.pixels;
  const double share = view.pixels / appearance->pixels;
  appearance->histogram =
      (1 - share) * appearance->histogram + share * view.histogram;
}

double ColorSimilarity(const Appearance& a, const Appearance& b) {
  return cv::compareHist(a.histogram, b.histogram, cv::HISTCMP_INTERSECT);
}

}  // namespace splitfusion
