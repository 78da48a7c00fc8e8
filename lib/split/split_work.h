#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_WORK_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_WORK_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/segment.h"
#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/lib/split/surface_prediction.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// What the splitter works on in one frame; images are HxW.
struct SplitWork {
  const Frame& frame;             ///< Live colour and depth.
  const PointMap& points;         ///< Of the live depth.
  SurfacePrediction prior;        ///< Complete: never empty.
  ComparedDepth compared;         ///< Live depth with the prior.
  std::vector<Segment> segments;  ///< One a surface or newcomer.
  LabelImage segment_labels;      ///< 1 + index of the segment; 0 = none.
  LabelImage labels;              ///< Surface ids; held parts have their own.
  cv::Mat_<uchar> unconfirmed;    ///< 255: detected, but no surface.
  SplitResult result;             ///< Under construction.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SPLIT_WORK_H_
