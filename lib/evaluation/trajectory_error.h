#ifndef SPLITFUSION_LIB_EVALUATION_TRAJECTORY_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_TRAJECTORY_ERROR_H_

#include <utility>
#include <vector>

#include "splitfusion/lib/evaluation/error_statistics.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// How two trajectories are compared (protocol of the TUM RGB-D benchmark).
struct TrajectoryErrorOptions {
  double max_time_difference = 0.02;           ///< Of a match, seconds.
  std::vector<int> relative_frames = {1, 30};  ///< Steps of the RPE, matches.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Error of the motion over a number of matched frames.
struct RelativePoseError {
  int frames = 0;                    ///< Step, in matched frames.
  ErrorStatistics translation;       ///< Metres.
  ErrorStatistics rotation_degrees;  ///< Degrees.
};

/// Result of CompareTrajectories.
struct TrajectoryError {
  int matched = 0;           ///< Pairs of poses.
  int estimated_poses = 0;   ///< Poses of the estimate.
  int true_poses = 0;        ///< Poses of the ground truth.
  double path_length = 0;    ///< Of the matched ground truth, metres.
  ErrorStatistics absolute;  ///< ATE: after alignment, metres.
  std::vector<RelativePoseError> relative;  ///< RPE, by step.
  /// The alignment of the ATE, by the positions: world of the ground truth from
  /// world of the estimate. Over a short or straight path its rotation is
  /// poorly known: millimetres over a path of decimetres are degrees.
  Rigid3d truth_from_estimate = Rigid3d::Identity();
  /// The same by whole poses: the mean of the rotations that turn each
  /// estimated camera into the true one, and the translation that fits then. To
  /// be used for placing surfaces.
  Rigid3d truth_from_estimate_by_poses = Rigid3d::Identity();
};

/// Pairs (estimate, truth) of indices by nearest time stamp, each pose used at
/// most once, the closest pairs first; ascending by estimate. Both trajectories
/// must be in order of time.
std::vector<std::pair<int, int>> MatchPoses(const Trajectory& estimate,
                                            const Trajectory& truth,
                                            double max_time_difference);

/// Absolute trajectory error after the best rigid alignment of the positions
/// (Horn, Umeyama; no scale) and relative pose error.
///
/// @throw InputError if fewer than three poses match; the message says how
///     many.
TrajectoryError CompareTrajectories(Trajectory estimate, Trajectory truth,
                                    const TrajectoryErrorOptions& options = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRAJECTORY_ERROR_H_
