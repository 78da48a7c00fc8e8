#include "splitfusion/lib/split/surface_extent.h"

#include <array>
#include <cmath>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSteps = {  // Layout.
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

}  // namespace

cv::Mat_<uchar> UnexplainedPixels(int surface, const ComparedDepth& compared) {
  const int nearer = static_cast<int>(DepthState::kOccluded);
  return ((compared.agreement == nearer) | (compared.background == nearer)) &
         ((compared.labels == 0) | (compared.labels == surface));
}

cv::Mat_<uchar> GrowOver(const cv::Mat_<uchar>& open,
                         const cv::Mat_<uchar>& seeds, const cv::Mat& depth,
                         const DepthNoise& noise) {
  cv::Mat_<uchar> extent = seeds.clone();
  std::vector<cv::Point> front;
  cv::findNonZero(seeds, front);
  while (!front.empty()) {
    const cv::Point at = front.back();
    front.pop_back();
    for (const auto& [du, dv] : kSteps) {
      const cv::Point next(at.x + du, at.y + dv);
      if (!next.inside({0, 0, extent.cols, extent.rows}) || !open(next) ||
          extent(next) ||
          IsDepthJump(depth.at<float>(at), depth.at<float>(next),
                      kSmoothDepth.At(depth.at<float>(at), noise))) {
        continue;
      }
      extent(next) = 255;
      front.push_back(next);
    }
  }
  return extent;
}

cv::Mat_<uchar> MissedExtent(int surface, const cv::Mat_<uchar>& others,
                             const ComparedDepth& compared,
                             const cv::Mat& depth) {
  const cv::Mat_<uchar> open = UnexplainedPixels(surface, compared) & ~others;
  return GrowOver(open,
                  AgreeingPixels(surface, compared.labels, compared.agreement),
                  depth, compared.noise);
}

cv::Mat_<uchar> Protrusions(const LabelImage& labels,
                            const cv::Mat_<uchar>& missed,
                            const ComparedDepth& compared,
                            const cv::Mat& depth) {
  const int unknown = static_cast<int>(DepthState::kUnmeasured);
  const cv::Mat_<uchar> unexplained = UnexplainedPixels(0, compared);
  const cv::Mat_<uchar> unmapped =
      (compared.agreement == unknown) & (compared.background == unknown);
  const auto grow = [&](const cv::Mat_<uchar>& open,
                        const cv::Mat_<uchar>& seeds) {
    return GrowOver(open, seeds, depth, compared.noise);
  };
  return (grow(unexplained, labels > 0) |
          grow(unexplained | unmapped, missed)) &
         (labels == 0);
}

}  // namespace splitfusion
