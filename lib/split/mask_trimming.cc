#include "splitfusion/lib/split/mask_trimming.h"

#include <tbb/parallel_for.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "splitfusion/lib/geometry/kd_tree.h"
#include "splitfusion/lib/split/surface_extent.h"

namespace splitfusion {
namespace {

constexpr float kReach = 0.35f;  // Metres.
constexpr int kStride = 4;  // Of the points that distances are measured to.
/// Share of a mask that must be where it was predicted to judge the rest.
constexpr double kMinPredicted = 0.25;

Eigen::Vector3f PointAt(const PointMap& points, int v, int u) {
  const cv::Vec3f& p = points.points(v, u);
  return {p[0], p[1], p[2]};
}

std::vector<Eigen::Vector3f> SparsePoints(const cv::Mat_<uchar>& pixels,
                                          const PointMap& points) {
  std::vector<Eigen::Vector3f> sparse;
  for (int v = 0; v < pixels.rows; v += kStride) {
    for (int u = 0; u < pixels.cols; u += kStride) {
      if (pixels(v, u) && points.points(v, u)[2] > 0) {
        sparse.push_back(PointAt(points, v, u));
      }
    }
  }
  return sparse;
}

/// Pixels of `rest` that are farther than kReach from all `body` points, 255.
cv::Mat_<uchar> OutOfReach(const cv::Mat_<uchar>& rest,
                           const std::vector<Eigen::Vector3f>& body,
                           const PointMap& points) {
  cv::Mat_<uchar> out(rest.size(), uchar(0));
  const KdTree tree(body);
  tbb::parallel_for(0, rest.rows, [&](int v) {
    for (int u = 0; u < rest.cols; ++u) {
      if (!rest(v, u)) continue;
      float distance = 0;
      tree.Nearest(PointAt(points, v, u), &distance);
      if (distance > kReach) out(v, u) = 255;
    }
  });
  return out;
}

cv::Mat_<uchar> ForeignPixels(const Segment& segment, const SplitWork& work) {
  const cv::Mat_<uchar> measured = work.frame.depth > 0;
  const cv::Mat_<uchar> predicted =
      AgreeingPixels(segment.surface, work.compared.labels,
                     work.compared.agreement) &
      segment.mask;
  const cv::Mat_<uchar> mask = segment.mask & measured;
  if (cv::countNonZero(predicted) < kMinPredicted * cv::countNonZero(mask)) {
    return {};
  }
  const cv::Mat_<uchar> body = GrowOver(mask, predicted, work.frame.depth);
  const std::vector<Eigen::Vector3f> points = SparsePoints(body, work.points);
  if (points.empty()) return {};
  cv::Mat_<uchar> foreign = OutOfReach(mask & ~body, points, work.points);
  // A rim of the mask is the graph cut's business.
  cv::morphologyEx(foreign, foreign, cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {7, 7}));
  return foreign;
}

}  // namespace

void TrimMasks(SplitWork* work) {
  for (Segment& segment : work->segments) {
    if (segment.surface == 0 || segment.mask.empty()) continue;
    const cv::Mat_<uchar> foreign = ForeignPixels(segment, *work);
    if (foreign.empty()) continue;
    // A new image: the mask's pixels are the caller's.
    const cv::Mat_<uchar> trimmed = segment.mask & ~foreign;
    segment.mask = trimmed;
    work->unconfirmed |= foreign;
  }
}

}  // namespace splitfusion
