#include "splitfusion/lib/split/uncertain_region.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {
namespace {

/// True where the depth jumps within the 3x3 neighbours.
bool IsDepthEdge(const cv::Mat& depth, int u, int v) {
  const float z = depth.at<float>(v, u);
  if (z <= 0) return false;
  const float gate = kSmoothDepth.At(z);
  for (int j = std::max(0, v - 1); j <= std::min(v + 1, depth.rows - 1); ++j) {
    for (int i = std::max(0, u - 1); i <= std::min(u + 1, depth.cols - 1);
         ++i) {
      const float other = depth.at<float>(j, i);
      if (other > 0 && IsDepthJump(z, other, gate)) return true;
    }
  }
  return false;
}

bool IsUncertain(const UncertainInput& input, const UncertainOptions& options,
                 float distance, int u, int v) {
  if (distance <= options.band || input.unconfirmed(v, u)) return true;
  const auto agreement = static_cast<DepthState>(input.agreement(v, u));
  const bool background_seen =
      input.predicted_labels(v, u) == 0 && agreement == DepthState::kObserved;
  if (input.detected(v, u) && !background_seen) return true;
  if (input.predicted_labels(v, u) > 0 && agreement != DepthState::kFree) {
    return true;
  }
  if (distance <= options.reach && agreement == DepthState::kOccluded) {
    return true;
  }
  return distance <= options.edge_band && IsDepthEdge(input.depth, u, v);
}

}  // namespace

void UncertainOptions::List(OptionList* list) {
  list->Number(
      "band", &band, {0, 100}, "pixels",
      "Background so near to an instance is neither tracked nor fused.");
  list->Number("edge_band", &edge_band, {0, 100}, "pixels",
               "The same beside depth edges.");
  list->Number("reach", &reach, {0, 1000}, "pixels",
               "The same for what stands in front of the background.");
}

cv::Mat_<uchar> DrawUncertainRegion(const UncertainInput& input,
                                    const UncertainOptions& options) {
  cv::Mat_<uchar> uncertain(input.labels.size(), uchar(0));
  cv::Mat background = (input.labels == 0) & ~input.unconfirmed;
  cv::Mat_<float> distance;
  cv::distanceTransform(background, distance, cv::DIST_L2, 3);
  tbb::parallel_for(0, uncertain.rows, [&](int v) {
    for (int u = 0; u < uncertain.cols; ++u) {
      if (input.labels(v, u) > 0) continue;
      if (IsUncertain(input, options, distance(v, u), u, v)) {
        uncertain(v, u) = 255;
      }
    }
  });
  return uncertain;
}

}  // namespace splitfusion
