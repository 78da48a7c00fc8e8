#include "splitfusion/lib/sequence/depth_filter.h"

#include <tbb/parallel_for.h>

#include <array>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// Of neighbours that are alike.
constexpr DepthTolerance<float> kAlike = {0.01f, 5};

/// (u, v) must not lie on the image border.
bool IsFlying(const cv::Mat& depth, const DepthNoise& noise, int u, int v) {
  const float z = depth.at<float>(v, u);
  constexpr std::array<std::array<int, 2>, 4> kDirections = {
      {{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  const auto compare = [&](int other_u, int other_v) {
    return ClassifyDepth(depth.at<float>(other_v, other_u), z,
                         kAlike.At(z, noise));
  };
  int alike = 0;
  bool between = false;
  for (const auto& [du, dv] : kDirections) {
    const DepthState a = compare(u + du, v + dv), b = compare(u - du, v - dv);
    alike += (a == DepthState::kObserved) + (b == DepthState::kObserved);
    between |= (a == DepthState::kOccluded && b == DepthState::kFree) ||
               (a == DepthState::kFree && b == DepthState::kOccluded);
  }
  // A pixel of a thin, slanted surface has at least two neighbours along it,
  // a mixed pixel of a straight edge at most two other mixed ones.
  return between && alike <= 2;
}

}  // namespace

void DepthOptions::List(OptionList* list) {
  list->Number("min_depth", &min_depth, Range::AtLeast(0), "metres",
               "Nearer depth is dropped.")
      .common = true;
  list->Number("max_depth", &max_depth, {0, 100}, "metres",
               "Farther depth is dropped.")
      .common = true;
  list->Demand(max_depth > min_depth, "max_depth", "metres > min_depth");
  list->Part("noise_", &noise);
}

void DepthOptions::Check() const { CheckOptions(*this); }

cv::Mat DepthInMetres(const cv::Mat& raw, double depth_scale) {
  cv::Mat depth;
  if (raw.depth() == CV_32F) {
    // Not `depth <= 0`, which is false for what is not a number.
    cv::Mat good = (raw > 0) & (raw <= std::numeric_limits<float>::max());
    raw.copyTo(depth, good);
    return depth;
  }
  raw.convertTo(depth, CV_32F, 1 / depth_scale);
  return depth;
}

void RemoveOutOfRange(double min_depth, double max_depth, cv::Mat* depth) {
  depth->setTo(0, (*depth < min_depth) | (*depth > max_depth));
}

void RemoveFlyingPixels(const DepthNoise& noise, cv::Mat* depth) {
  const cv::Mat source = depth->clone();
  tbb::parallel_for(1, source.rows - 1, [&](int v) {
    for (int u = 1; u + 1 < source.cols; ++u) {
      if (source.at<float>(v, u) > 0 && IsFlying(source, noise, u, v)) {
        depth->at<float>(v, u) = 0;
      }
    }
  });
}

cv::Mat FilterDepth(const cv::Mat& depth, const DepthOptions& options) {
  cv::Mat filtered = depth.clone();
  RemoveOutOfRange(options.min_depth, options.max_depth, &filtered);
  RemoveFlyingPixels(options.noise, &filtered);
  return filtered;
}

}  // namespace splitfusion
