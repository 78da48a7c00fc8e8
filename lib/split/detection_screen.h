#ifndef SPLITFUSION_LIB_SPLIT_DETECTION_SCREEN_H_
#define SPLITFUSION_LIB_SPLIT_DETECTION_SCREEN_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/merge_groups.h"
#include "splitfusion/lib/split/segment.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/split/split_result.h"

namespace splitfusion {

/// True if instances of this class get surfaces of their own.
bool IsTrackable(const std::string& class_name, const LabelTable& table,
                 const SplitOptions& options);

/// Says of detections how far they may be trusted (score, class, area). What
/// another may hold is trusted whatever its kind.
std::vector<Candidate> ScreenDetections(
    const std::vector<InstanceMask>& detections, const LabelTable& table,
    const std::vector<MergeGroup>& groups, const SplitOptions& options);

/// Detections sorted into surfaces and newcomers.
struct SortedDetections {
  std::vector<Segment> segments;  ///< One a surface or newcomer.
  /// HxW, 255 inside detections too weak to become a surface.
  cv::Mat_<uchar> unconfirmed;
  std::vector<SplitDecision> decisions;  ///< On pieces and ignored ones.
};

/// Joins the detections of each surface; what matches none and may be trusted
/// becomes a newcomer. `matches`: one a candidate. `size`: of the frame.
SortedDetections SortDetections(const std::vector<Candidate>& candidates,
                                const std::vector<Match>& matches,
                                const LabelTable& table,
                                const SplitOptions& options, cv::Size size);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_DETECTION_SCREEN_H_
