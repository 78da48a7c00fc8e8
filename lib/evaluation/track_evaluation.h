#ifndef SPLITFUSION_LIB_EVALUATION_TRACK_EVALUATION_H_
#define SPLITFUSION_LIB_EVALUATION_TRACK_EVALUATION_H_

#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/track_error.h"

namespace splitfusion {

/// Which true track points are followed.
struct TrackOptions {
  /// Frames in which the points are given; empty = one: that in which most of
  /// them are visible (the first of these), `frames` before the end of the run
  /// and of the truth. In a shorter run half of it is followed, or less if no
  /// point is visible so early.
  std::vector<int> references;
  int frames = 30;  ///< Frames through which they are followed.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Result of following the true track points through a run.
struct TrackEvaluation {
  TrackErrors errors;    ///< Against the truth, metres.
  int attached = 0;      ///< Points attached to a surface.
  int unattached = 0;    ///< Points that stayed where they were.
  bool by_mask = false;  ///< Whether masks told the surface of a point.
};

/// Follows the points of every reference frame; one that cannot be used is a
/// line of `skipped`.
///
/// @return by reference frame.
/// @throw InputError if tracks.bin is broken.
std::vector<TrackEvaluation> EvaluateTracks(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const TrackOptions& options,
    std::vector<std::string>* skipped);

/// Plain means of all figures over the reference frames; of counts the sums, of
/// `frames` the largest. `reference_frame` is -1 if there are several.
TrackEvaluation MeanOf(const std::vector<TrackEvaluation>& references);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRACK_EVALUATION_H_
