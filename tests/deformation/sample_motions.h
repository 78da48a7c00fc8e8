#ifndef SPLITFUSION_TESTS_DEFORMATION_SAMPLE_MOTIONS_H_
#define SPLITFUSION_TESTS_DEFORMATION_SAMPLE_MOTIONS_H_

#include "splitfusion/lib/deformation/motion_history.h"

namespace splitfusion {

inline NodeMotion Motion(double value) {
  NodeMotion motion;
  motion.rotation = ExpSo3({value, -0.5 * value, 2 * value});
  motion.translation = Eigen::Vector3d(value, 2, -3);
  return motion;
}

/// Frames 3 and 5 of two nodes.
inline MotionHistory TwoFrames() {
  MotionHistory history;
  history.Append({3, true, {Motion(0.1), Motion(0.2)}, {0, 1}});
  history.Append({5, false, {Motion(0.3), Motion(0.4)}});
  return history;
}

/// Three nodes, of which the first two are in use in frame 3, the last one,
/// too, in frame 4, and that alone in frame 5.
inline MotionHistory SomeInUse() {
  MotionHistory history;
  history.Append({3, true, {Motion(0.1), Motion(0.2)}, {0, 1}, {{0, 2}}});
  history.Append({4, true, {Motion(0.3), Motion(0.4), Motion(0.5)}, {1, 0, 1}});
  history.Append({5, true, {Motion(0.6)}, {1}, {{2, 3}}});
  return history;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_DEFORMATION_SAMPLE_MOTIONS_H_
