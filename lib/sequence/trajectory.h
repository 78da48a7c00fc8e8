#ifndef SPLITFUSION_LIB_SEQUENCE_TRAJECTORY_H_
#define SPLITFUSION_LIB_SEQUENCE_TRAJECTORY_H_

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// One pose of a trajectory.
struct TimedPose {
  double timestamp = 0;                             ///< Seconds.
  Rigid3d world_from_camera = Rigid3d::Identity();  ///< Metres.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(timestamp, world_from_camera);
  }
};

/// Poses in order of time stamps.
using Trajectory = std::vector<TimedPose>;

/// Reads TUM text: `timestamp tx ty tz qx qy qz qw`, `#` comments; the poses
/// are camera-to-world, metres.
///
/// @throw InputError on a missing file or a line that does not parse; names
///     file and line.
Trajectory ReadTumTrajectory(const std::string& path);

/// The pose nearest to a time stamp, at most 0.02 s away as in the tools of the
/// TUM benchmark; none if there is no such pose.
std::optional<Rigid3d> PoseAt(const Trajectory& trajectory, double timestamp);

/// Four poses in order of time between the middle ones of which a camera moved
/// unseen. Outer ones of the same time as their neighbours: none is known.
struct UnseenMotion {
  TimedPose earlier;  ///< Says how it moved before.
  TimedPose from;     ///< Last known.
  TimedPose to;       ///< Next known.
  TimedPose later;    ///< Says how it moved after.
};

/// The pose at a time amid an unseen motion, metres: cubic Hermite curves
/// through the known places and turns, with the velocities there; without one
/// that of the straight way.
Rigid3d PoseAmid(const UnseenMotion& motion, double timestamp);

/// Writes the comment line that heads a TUM text file.
void WriteTumHeader(std::ostream& out);

/// Writes one line of TUM text, for files that grow frame by frame.
void WriteTumPose(std::ostream& out, const TimedPose& pose);

/// Writes TUM text (6 decimals of time, 9 significant digits of the pose).
///
/// @throw InputError if the file cannot be written.
void WriteTumTrajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_TRAJECTORY_H_
