#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/split/appearance.h"
#include "splitfusion/lib/split/split_decision.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// A detection of a rigid class that counts as background.
struct StandingObject {
  cv::Mat_<uchar> mask;    ///< HxW, 255 inside.
  std::string class_name;  ///< As detected.
  double score = 0;        ///< 0..1.
  Appearance appearance;   ///< Of its pixels.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mask, class_name, score, appearance);
  }
};

/// Result of one frame.
struct SplitResult {
  LabelImage labels;  ///< HxW: surface id of every pixel, 0 = background.
  /// HxW 8UC1: 255 where the pixel may be background but is too close to a
  /// foreign or unexplained instance to be tracked or fused as such.
  cv::Mat uncertain;
  std::vector<SplitDecision> decisions;  ///< In the order they were taken.
  /// Those that move are to be told by SurfaceSplitter::BelieveMoving().
  std::vector<StandingObject> standing;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SPLIT_RESULT_H_
