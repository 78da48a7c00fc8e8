#ifndef SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_
#define SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_

#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/surface_error.h"

namespace splitfusion {

/// What the model shows where the camera truly sees an instance.
struct ViewError {
  int pixels = 0;     ///< Pixels of the instance.
  int uncovered = 0;  ///< Those where the model shows nothing.
  /// Distance of the model's points at the others from the true surface.
  SurfaceDistances distances;
};

/// Error of one moving instance in one frame.
struct InstanceFrameError {
  int frame = 0;         ///< Frame index.
  bool matched = false;  ///< Whether the matched surface was tracked there.
  SurfaceError surface;  ///< Of the matched surface; zero if not `matched`.
  ViewError view;        ///< Of the whole model; zero without label images.
};

/// Error of one moving instance.
struct InstanceError {
  int instance = 0;           ///< Instance id.
  std::string name;           ///< Of the ground truth; may be empty.
  int surface_id = -1;        ///< The surface matched to it; -1 = none.
  std::string surface_label;  ///< Its label.
  std::vector<InstanceFrameError> frames;  ///< Where there is a true mesh.
};

/// Compares the surfaces of a run with the true meshes of moving instances.
///
/// At every frame that has a true mesh the model is warped to that frame and
/// put into the true world with the true camera pose of the frame, so that
/// errors of the camera pose do not count. An instance is matched to the one
/// surface (not the background) with the greatest mean F-score at 50 mm, every
/// surface to one instance at most. Frames in which the surface was not
/// tracked do not count for it.
///
/// The view error asks the same of all surfaces together, whatever they are
/// called: at the pixels that label/STEM.png gives to the instance. It can be
/// compared between runs with and without a surface for the instance.
///
/// @return by instance; empty if there is no true mesh.
/// @throw InputError if a file of the ground truth is broken.
std::vector<InstanceError> CompareInstances(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const SurfaceErrorOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_INSTANCE_ERROR_H_
