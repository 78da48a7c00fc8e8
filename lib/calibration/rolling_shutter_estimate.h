#ifndef SPLITFUSION_LIB_CALIBRATION_ROLLING_SHUTTER_ESTIMATE_H_
#define SPLITFUSION_LIB_CALIBRATION_ROLLING_SHUTTER_ESTIMATE_H_

#include <functional>
#include <optional>
#include <string>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// What the images say of how their rows were exposed.
struct RollingShutterEstimate {
  /// From the first row to the last one, seconds.
  double seconds = 0;
  /// Standard error of it, from how pairs of frames differ, seconds.
  double error = 0;
  int pairs = 0;    ///< Of frames, that tell.
  double turn = 0;  ///< Median difference of their rotations a frame, degrees.
  double interval = 0;  ///< Between frames, median, seconds.

  /// Whether the rows were certainly exposed one after the other: by five
  /// standard errors, for .15 of the interval between frames at least, and no
  /// longer than that as far as it is known.
  bool IsNeeded() const;
  /// One line for people.
  std::string Text() const;
};

/// Estimates the time t that the rows of an image take. Frames i and j that
/// show the same while the camera turned differently are distorted differently:
/// features (ORB) of both, X of i by its depth and u of j, agree if
///
///   u = pi(X' + k(u) t V_j X'),   X' = T (X - k(X) t V_i X)
///
/// where V X is the velocity of points that stand still in the camera frame (by
/// features of the frames before and after), k how far the row lies below the
/// middle as a share of the height, and T, the motion between the frames, is
/// sought with t, which all pairs have in common; robust least squares (Ceres).
///
/// `read(i)`: frame i of `frames`, none if it cannot be read; called from
/// several threads. Same frames, same bytes.
RollingShutterEstimate EstimateRollingShutter(
    const std::function<std::optional<Frame>(int)>& read, int frames,
    const PinholeCamera& camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_CALIBRATION_ROLLING_SHUTTER_ESTIMATE_H_
