#ifndef SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_
#define SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/visibility/seen_space.h"

namespace splitfusion {

struct Candidate;

/// What is known of a frame when its moving objects are looked for.
struct MotionView {
  int frame = 0;                     ///< Index.
  const cv::Mat& depth;              ///< HxW 32FC1, metres, 0 = none.
  const PointMap& points;            ///< Camera frame, metres.
  const Rigid3d& world_from_camera;  ///< Predicted pose.
  /// HxW, 255: on what is known to move anyway; tells nothing of others.
  cv::Mat_<uchar> claimed;
  /// HxW, 255: nearer than the mapped background.
  cv::Mat_<uchar> in_front;
};

/// Watches what stands where space was seen empty: detections of rigid classes,
/// which are background until a large part of one does, and whatever else is in
/// front of the background.
class MovingObjects {
 public:
  /// `options`: as checked.
  MovingObjects(const PinholeCamera& camera, const SplitOptions& options);

  /// Marks those candidates of rigid classes as `moved` that stand where space
  /// was empty, and returns such pixels, of them and of whatever else is in
  /// front of the background: HxW, 255. They are no background: what stands
  /// there came after, detected or not.
  cv::Mat_<uchar> Watch(const MotionView& view,
                        std::vector<Candidate>* candidates);

  /// Whether a candidate is of a rigid class and no background for no other
  /// reason than that.
  bool IsWatched(const Candidate& candidate) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(space_);
  }

 private:
  SplitOptions options_;
  SeenSpace space_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_MOVING_OBJECTS_H_
