#ifndef SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/model_inspection.h"
#include "splitfusion/lib/evaluation/presence.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/seen_score.h"
#include "splitfusion/lib/evaluation/surface_error.h"
#include "splitfusion/lib/evaluation/true_occasion.h"

namespace splitfusion {

/// What the model shows where the camera truly sees an instance.
struct ViewError {
  int pixels = 0;     ///< Pixels of the instance.
  int uncovered = 0;  ///< Those where the model shows nothing.
  /// Distance of the model's points at the others from the true surface.
  SurfaceDistances distances;

  /// `uncovered` / `pixels`; 0 without pixels.
  double MissingShare() const {
    return pixels > 0 ? static_cast<double>(uncovered) / pixels : 0;
  }
  /// Part of all pixels at which the model is within kSurfaceThresholds[i] of
  /// the truth.
  double RightShare(std::size_t i) const {
    return distances.within[i] * (1 - MissingShare());
  }
};

/// Error of one moving instance in one frame.
struct InstanceFrameError {
  int frame = 0;  ///< Frame index.
  /// Whether it is in plain view and its surface does not show it: then both
  /// errors are the worst that there can be.
  bool missing = false;
  /// Whether `surface` counts: the matched surface was tracked there, or the
  /// instance is missing.
  bool matched = false;
  SurfaceError surface;  ///< Of the matched surface; zero if not `matched`.
  ViewError view;        ///< Of the whole model; zero without label images.
};

/// Error of one moving instance.
struct InstanceError {
  int instance = 0;           ///< Instance id.
  std::string name;           ///< Of the ground truth; may be empty.
  bool rigid = false;         ///< Whether the ground truth calls it rigid.
  int surface_id = -1;        ///< The surface matched to it; -1 = none.
  std::string surface_label;  ///< Its label.
  std::vector<InstanceFrameError> frames;    ///< Where there is a true mesh.
  std::optional<InstancePresence> presence;  ///< If it is known.
  std::optional<SeenScore> seen;      ///< If it is known, and it is not rigid.
  std::optional<SurfaceShape> shape;  ///< Of the surface matched.
};

/// Compares the surfaces of a run with the true meshes of moving instances.
///
/// At every frame that has a true mesh the model is warped to that frame and
/// put into the true world with the true camera pose of the frame, so that
/// errors of the camera pose do not count. An instance is matched to the one
/// surface (not the background) with the greatest mean F-score at 50 mm, every
/// surface to one instance at most. Frames in which the surface was not
/// tracked do not count for it, unless the instance is in plain view: then it
/// is missing (`presences`, by instance; may be empty), and counts with the
/// greatest distance and F-scores of 0. So it does where it is shown by
/// another surface than the matched one alone.
///
/// The view error asks the same of all surfaces together, whatever they are
/// called: at the pixels that label/STEM.png gives to the instance. It can be
/// compared between runs with and without a surface for the instance. Where the
/// instance is missing, all its pixels are uncovered.
///
/// @return by instance, those of `presences` too; of `presence`, `seen` and
///     `shape` only the first is filled in.
/// @throw InputError if a file of the ground truth is broken.
std::vector<InstanceError> CompareInstances(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const std::vector<TrueOccasion>& occasions,
    const std::map<int, InstancePresence>& presences,
    const SurfaceErrorOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_
