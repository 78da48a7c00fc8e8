#include "splitfusion/lib/visibility/exposure.h"

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// Of what is nearer than a model.
constexpr DepthTolerance<float> kInFront = {0.1f};

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
        hidden += ClassifyDepth(depth, model(v, u), kInFront.At(depth)) ==
                  DepthState::kOccluded;
      }
    }
  }
  return hidden > 0 ? seen / static_cast<double>(seen + hidden) : 1;
}

}  // namespace splitfusion
