#ifndef SPLITFUSION_LIB_EVALUATION_TRACK_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_TRACK_ERROR_H_

#include <map>
#include <vector>

#include "splitfusion/lib/evaluation/error_statistics.h"
#include "splitfusion/lib/evaluation/track_point.h"
#include "splitfusion/lib/evaluation/true_tracks.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Distances of followed points from where they truly are, metres; over all
/// frames but the reference frame.
struct TrackError {
  ErrorStatistics visible;   ///< Points that the camera sees in the frame.
  ErrorStatistics occluded;  ///< The others.
  /// What the visible points would have if every point stayed where it was in
  /// the world in the reference frame.
  ErrorStatistics still_world;
  /// What they would have if every instance moved by the rigid motion that
  /// fits the true points best: what is left is the non-rigid part. Instances
  /// with fewer than four points do not count.
  ErrorStatistics rigid;
};

/// Track error of all points and of those of every instance.
struct TrackErrors {
  int reference_frame = 0;  ///< Frame in which the points were given.
  int frames = 0;           ///< Frames after it.
  int points = 0;           ///< Points followed.
  TrackError all;           ///< Over all instances.
  std::map<int, TrackError> instances;  ///< Instance -> error.
};

/// Compares followed points with the truth in the camera frame of every frame,
/// so that errors of the camera pose do not count.
///
/// `world_from_camera`: true poses, one for each frame of `truth`.
/// @throw InputError if a point or frame is not in the truth.
TrackErrors CompareTracks(const std::vector<TrackPoint>& followed,
                          const TrueTracks& truth,
                          const std::vector<Rigid3d>& world_from_camera,
                          int reference_frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRACK_ERROR_H_
