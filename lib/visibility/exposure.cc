#include "splitfusion/lib/visibility/exposure.h"

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// Of what is nearer than a model, and of a model that is where it is seen.
constexpr DepthTolerance<float> kTolerance = {0.1f, 0};

}  // namespace

double Exposure(const cv::Mat_<float>& model, int step, const LiveView& live,
                int surface) {
  int seen = 0;
  int hidden = 0;
  for (int v = 0; v < model.rows && v * step < live.depth.rows; ++v) {
    for (int u = 0; u < model.cols && u * step < live.depth.cols; ++u) {
      const float depth = live.depth(v * step, u * step);
      if (!(depth > 0)) continue;
      if (live.labels(v * step, u * step) == surface) {
        ++seen;
      } else {
        hidden += ClassifyDepth(depth, model(v, u), kTolerance.At(depth)) ==
                  DepthState::kOccluded;
      }
    }
  }
  return hidden > 0 ? seen / static_cast<double>(seen + hidden) : 1;
}

double Explained(const cv::Mat_<float>& model, int step, const LiveView& live,
                 int surface) {
  int seen = 0;
  int explained = 0;
  for (int v = 0; v < model.rows && v * step < live.depth.rows; ++v) {
    for (int u = 0; u < model.cols && u * step < live.depth.cols; ++u) {
      const float depth = live.depth(v * step, u * step);
      if (!(depth > 0) || live.labels(v * step, u * step) != surface) continue;
      ++seen;
      explained += ClassifyDepth(depth, model(v, u), kTolerance.At(depth)) ==
                   DepthState::kObserved;
    }
  }
  return seen > 0 ? explained / static_cast<double>(seen) : 0;
}

}  // namespace splitfusion
