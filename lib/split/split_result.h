#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/split/split_decision.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// Result of one frame.
struct SplitResult {
  LabelImage labels;  ///< HxW: surface id of every pixel, 0 = background.
  /// HxW 8UC1: 255 where the pixel may be background but is too close to a
  /// foreign or unexplained instance to be tracked or fused as such.
  cv::Mat uncertain;
  std::vector<SplitDecision> decisions;  ///< In the order they were taken.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_
