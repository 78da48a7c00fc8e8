#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// One decision, for the report.
struct SplitDecision {
  /// "matched": a detection of a known surface. "merged": a piece of one, what
  /// it holds, or a surface that turned out to be a piece. "born", "revived": a
  /// new surface, a dormant one seen again. "missed", "dormant": a surface
  /// without detection, carried or given up. "pending", "ignored": a detection
  /// that may yet become a surface, or may not.
  std::string action;
  int surface = 0;         ///< Surface id, 0 if none.
  std::string class_name;  ///< Of the detection, or of a missed surface.
  double score = 0;        ///< Of the detection; 0 if none.
  double overlap = 0;      ///< IoU with the projected surface; 0 if none.
};

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
