#ifndef SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_
#define SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/split/birth_queue.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/visibility/seen_space.h"

namespace splitfusion {

/// What is known of a frame when its moving objects are looked for.
struct MotionView {
  int frame = 0;                     ///< Index.
  const cv::Mat& depth;              ///< HxW 32FC1, metres, 0 = none.
  const PointMap& points;            ///< Camera frame, metres.
  const Rigid3d& world_from_camera;  ///< Predicted pose.
  /// Whether the live depth lies on the mapped background, as it does if the
  /// pose is right.
  bool pose_fits = true;
  /// HxW, 255: on what is known to move anyway; tells nothing of others.
  cv::Mat_<uchar> claimed;
};

/// Watches detections of rigid classes, which are background until they are
/// seen to have moved: until a large part of one stands, in several of the
/// last frames, where space was seen empty before.
class MovingObjects {
 public:
  /// `options`: as checked.
  MovingObjects(const PinholeCamera& camera, const SplitOptions& options);

  /// Gives Trust::kFull to candidates that have moved, and marks as `moved`
  /// those that seem to. Returns the pixels of all watched candidates that
  /// stand where space was empty: HxW, 255; they are no background. Nothing
  /// if rigid classes have surfaces of their own anyway.
  cv::Mat_<uchar> Watch(const MotionView& view, const LabelTable& table,
                        std::vector<Candidate>* candidates);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(space_, moved_);
  }

 private:
  bool IsWatched(const Candidate& candidate, const LabelTable& table) const;

  SplitOptions options_;
  SeenSpace space_;
  BirthQueue moved_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_
