#ifndef SPLITFUSION_LIB_EVALUATION_DEPTH_AGREEMENT_H_
#define SPLITFUSION_LIB_EVALUATION_DEPTH_AGREEMENT_H_

#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/error_statistics.h"
#include "splitfusion/lib/evaluation/recorded_run.h"

namespace splitfusion {

/// How well one surface of the final model, carried to the frames of the run,
/// lies on what the camera measured there.
struct DepthAgreement {
  int surface_id = 0;         ///< 0 is the background.
  std::string surface_label;  ///< Its label.
  int frames = 0;             ///< Frames looked at in which it was tracked.
  /// Frames in which it was not tracked although it was in plain view; all its
  /// pixels are uncovered there.
  int frames_missing = 0;
  int pixels = 0;         ///< Live pixels with depth that are the surface's.
  int uncovered = 0;      ///< Those at which the model does not show it.
  int other_surface = 0;  ///< Of these, where it shows another one.
  /// |z-depth of the model - live depth| at the others, metres; median and p90
  /// to 0.1 mm.
  ErrorStatistics distances;

  /// `uncovered` / `pixels`; 0 without pixels.
  double UncoveredFraction() const {
    return pixels > 0 ? static_cast<double>(uncovered) / pixels : 0;
  }
};

/// Compares the final meshes of a run, warped by its motions, with the live
/// depth in every `every`-th frame. What no ground truth is needed for.
///
/// Rendered are the surfaces that were tracked in the frame (or born in it).
/// The pixels of a surface are those that RUN/masks/STEM.png gives to it and
/// that have depth after the filter that the run applied. One frame is read at
/// a time. A surface that was not tracked in a frame in which the mask gives
/// more than `plain_view_pixels` of these to it is missing there: they are
/// uncovered.
///
/// `surfaces`: those of `run`.
/// @return by surface; those that were tracked in no such frame have 0 frames.
/// @throw InputError if the run does not say where the sequence is or has no
///     camera, or if an image of the sequence or a mask is missing or broken.
std::vector<DepthAgreement> CompareDepth(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    int every, int plain_view_pixels);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_DEPTH_AGREEMENT_H_
