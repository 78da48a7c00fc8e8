#ifndef SPLITFUSION_TESTS_SUPPORT_ROLLING_ROOM_H_
#define SPLITFUSION_TESTS_SUPPORT_ROLLING_ROOM_H_

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// A corner of a room with a pattern all over, seen by a camera that turns to
/// and fro; its rows are exposed one after the other.
struct RollingRoom {
  double seconds = 0;  ///< From the first row to the last one.
  /// Of the images.
  PinholeCamera camera{320, 240, 260, 260, 159.5, 119.5};

  /// Seconds between frames.
  static constexpr double kInterval = 1 / 30.0;

  /// World from camera at a time, seconds.
  static Rigid3d PoseAt(double time);

  /// Frame i; its time is that of the middle row.
  Frame At(int i) const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_ROLLING_ROOM_H_
