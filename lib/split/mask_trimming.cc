#include "splitfusion/lib/split/mask_trimming.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "splitfusion/lib/split/surface_extent.h"

namespace splitfusion {
namespace {

constexpr float kReach = 0.35f;  // Metres.
/// Share of a mask that must be where it was predicted to judge the rest.
constexpr double kMinPredicted = 0.25;

/// Depths of the `pixels` but for the nearest and farthest 2 %, metres; an
/// empty range (end before start) if there are none.
std::pair<float, float> DepthRange(const cv::Mat_<uchar>& pixels,
                                   const cv::Mat_<float>& depth) {
  std::vector<float> depths;
  for (int v = 0; v < pixels.rows; ++v) {
    for (int u = 0; u < pixels.cols; ++u) {
      if (pixels(v, u)) depths.push_back(depth(v, u));
    }
  }
  if (depths.empty()) return {1, 0};
  const auto at = [&](double share) {
    const auto place =
        depths.begin() + static_cast<int>(share * (depths.size() - 1));
    std::nth_element(depths.begin(), place, depths.end());
    return *place;
  };
  const float nearest = at(0.02);
  return {nearest, at(0.98)};
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
  const auto [nearest, farthest] = DepthRange(body, work.frame.depth);
  if (farthest < nearest) return {};
  cv::Mat_<uchar> foreign = mask & ~body &
                            ((work.frame.depth < nearest - kReach) |
                             (work.frame.depth > farthest + kReach));
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
