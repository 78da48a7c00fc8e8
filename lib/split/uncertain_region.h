#ifndef SPLITFUSION_LIB_SPLIT_UNCERTAIN_REGION_H_
#define SPLITFUSION_LIB_SPLIT_UNCERTAIN_REGION_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// How far from an instance the background is left alone.
struct UncertainOptions {
  int band = 5;        ///< Pixels around every instance.
  int edge_band = 10;  ///< Pixels around it in which depth edges count too.
  int reach = 30;      ///< Pixels around it in which everything in front of
                       ///< the background counts too.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// What is known of a frame when the uncertain region is drawn; all HxW.
struct UncertainInput {
  LabelImage labels;            ///< Surfaces of this frame.
  cv::Mat_<uchar> unconfirmed;  ///< 255: detected, but no surface.
  cv::Mat_<uchar> detected;     ///< 255: in the mask of any surface.
  LabelImage predicted_labels;  ///< Surfaces expected in this frame.
  cv::Mat_<uchar> agreement;    ///< A DepthState.
  cv::Mat depth;                ///< 32FC1, metres, 0 = none.
};

/// Background pixels that must not be tracked or fused as background, 8UC1,
/// 255: a band around every surface, unconfirmed detections, what a detector
/// or the projection gave to a surface but the cut did not, and what stands in
/// front of the known background near a surface.
cv::Mat_<uchar> DrawUncertainRegion(const UncertainInput& input,
                                    const UncertainOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_UNCERTAIN_REGION_H_
