#ifndef SPLITFUSION_LIB_EVALUATION_POINT_FOLLOWER_H_
#define SPLITFUSION_LIB_EVALUATION_POINT_FOLLOWER_H_

#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/track_point.h"

namespace splitfusion {

/// Result of FollowPoints.
struct FollowedPoints {
  /// Every query in every frame, by frame, then in the order of the queries.
  std::vector<TrackPoint> points;
  int attached = 0;      ///< Queries attached to a surface.
  int unattached = 0;    ///< Queries that never were.
  bool by_mask = false;  ///< Whether masks told the surface of a query.
};

/// Says where the warp fields of a run carry surface points.
///
/// Every query (camera frame) is attached to the model surface as it lies in
/// the query's frame (SurfaceAttacher; the surface of RUN/masks/STEM.png at the
/// query's pixel goes first, if there are such masks and the camera is known)
/// and carried through the following `frames` frames, as far as the run goes.
/// A query that no surface is near to may still be taken up by a surface that
/// is born in a later frame, in that frame. While a query is not attached, or
/// its surface has no motions, it stays where it was last in the run's world.
///
/// `surfaces`: those of the run. All queries must be of one frame.
/// @throw InputError if the queries are of several frames or of one that the
///     run does not have, or if a mask is broken.
FollowedPoints FollowPoints(const RecordedRun& run,
                            const std::vector<AnimatedSurface>& surfaces,
                            const std::vector<TrackPoint>& queries, int frames);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_POINT_FOLLOWER_H_
