#ifndef SPLITFUSION_LIB_SYNTHETIC_BODY_MOTION_H_
#define SPLITFUSION_LIB_SYNTHETIC_BODY_MOTION_H_

#include "splitfusion/lib/synthetic/body_model.h"

namespace splitfusion {

/// What the person does: it walks a quarter of an oval through the free middle
/// of the room, waving, then stands for an action (bends down; raises its arms
/// and leans; squats; bends and turns), and so on without end. One quarter
/// takes 5 s; time 0 is in the middle of a step.
class BodyMotion {
 public:
  /// Without `walks` the person stays at the world's origin, facing -y, and
  /// does its gestures there.
  explicit BodyMotion(bool walks) : walks_(walks) {}

  /// Pose at `time` seconds; planted feet do not slide.
  BodyPose PoseAt(double time) const;

 private:
  bool walks_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_BODY_MOTION_H_
