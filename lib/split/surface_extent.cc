#include "splitfusion/lib/split/surface_extent.h"

#include <array>
#include <cmath>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {
namespace {

constexpr std::array<std::array<int, 2>, 4> kSteps = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

bool Continuous(float a, float b) {
  return std::abs(a - b) <= 4 * DepthSigma(a) + 0.02f;
}

/// Pixels that nothing but the surface itself can explain.
cv::Mat_<uchar> Unexplained(int surface, const cv::Mat_<uchar>& blocked,
                            const ComparedDepth& compared) {
  const int nearer = static_cast<int>(Agreement::kNearer);
  cv::Mat_<uchar> open =
      ((compared.agreement == nearer) | (compared.background == nearer)) &
      ((compared.labels == 0) | (compared.labels == surface));
  if (!blocked.empty()) open.setTo(0, blocked);
  return open;
}

}  // namespace

cv::Mat_<uchar> GrowOverUnexplained(int surface, const cv::Mat_<uchar>& seeds,
                                    const cv::Mat_<uchar>& blocked,
                                    const ComparedDepth& compared,
                                    const cv::Mat& depth) {
  cv::Mat_<uchar> extent = seeds.clone();
  const cv::Mat_<uchar> open = Unexplained(surface, blocked, compared);
  std::vector<cv::Point> front;
  cv::findNonZero(seeds, front);
  while (!front.empty()) {
    const cv::Point at = front.back();
    front.pop_back();
    for (const auto& [du, dv] : kSteps) {
      const cv::Point next(at.x + du, at.y + dv);
      if (!next.inside({0, 0, extent.cols, extent.rows}) || !open(next) ||
          extent(next) ||
          !Continuous(depth.at<float>(at), depth.at<float>(next))) {
        continue;
      }
      extent(next) = 255;
      front.push_back(next);
    }
  }
  return extent;
}

}  // namespace splitfusion
