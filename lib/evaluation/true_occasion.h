#ifndef SPLITFUSION_LIB_EVALUATION_TRUE_OCCASION_H_
#define SPLITFUSION_LIB_EVALUATION_TRUE_OCCASION_H_

#include <vector>

#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/surface_error.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

class AnimatedSurface;

/// A true mesh of an instance together with the frame of the run it belongs to.
struct TrueOccasion {
  int instance = 0;                      ///< Instance id.
  const RecordedFrame* frame = nullptr;  ///< Not owned.
  Rigid3d world_from_camera;             ///< True pose.
  TrueSurface truth;                     ///< World frame.
};

/// The true meshes of all instances, by instance and time; those without a
/// frame of the run or a true pose within 0.02 s are left out.
///
/// @throw InputError if a mesh is broken.
std::vector<TrueOccasion> FindOccasions(const RecordedRun& run,
                                        const GroundTruth& truth);

/// The model of a surface in a frame that it has motions for, put into the true
/// world with the true pose of that frame; empty if it has no triangle then.
TriangleMesh ModelInWorld(const AnimatedSurface& surface,
                          const TrueOccasion& occasion);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_TRUE_OCCASION_H_
