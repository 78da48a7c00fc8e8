#include "splitfusion/lib/visibility/exposure.h"

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
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
        hidden += ClassifyDepth(depth, model(v, u),
                                kOneBody.At(depth, live.camera.noise)) ==
                  DepthState::kOccluded;
      }
    }
  }
  return hidden > 0 ? seen / static_cast<double>(seen + hidden) : 1;
}

}  // namespace splitfusion
