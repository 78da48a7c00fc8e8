#ifndef SPLITFUSION_PIPELINES_LOOP_CLOSURE_H_
#define SPLITFUSION_PIPELINES_LOOP_CLOSURE_H_

#include <map>
#include <vector>

#include "splitfusion/lib/geometry/depth_noise.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/report/loop_report.h"
#include "splitfusion/lib/tracking/key_frames.h"

namespace splitfusion {

/// Poses without drift.
struct LoopClosure {
  std::map<int, Rigid3d> world_from_camera;  ///< By frame, metres.
  LoopReport report;                         ///< How they came about.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(world_from_camera, report);
  }
};

/// Closes the loops of a camera's path, see SolvePoseGraph(): key frames that
/// follow each other are as far apart as they were tracked, unless the camera
/// was lost between them, and pairs that look alike as their landmarks say.
/// Poses stay as they are unless such a pair contradicts them by more than
/// `reach`, metres, from where tracking would have found back by itself.
///
/// @param tracked of frames in which the camera was tracked, world from camera.
/// @return poses of these frames; the first key frame's stays as it was, and
///     between two of them the correction changes evenly.
LoopClosure CloseLoops(const std::vector<PathFrame>& path,
                       const std::map<int, Rigid3d>& tracked,
                       const DepthNoise& noise, const KeyFrameOptions& options,
                       double reach);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_LOOP_CLOSURE_H_
