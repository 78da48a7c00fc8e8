#ifndef SPLITFUSION_TESTS_SUPPORT_MOTION_FRAMES_H_
#define SPLITFUSION_TESTS_SUPPORT_MOTION_FRAMES_H_

#include <functional>
#include <vector>

#include "splitfusion/lib/deformation/motion_history.h"
#include "splitfusion/lib/model/retired_models.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// All frames of a history.
std::vector<FrameMotions> FramesOf(const MotionHistory& history);

/// The history of some frames; `memory`: bytes that it keeps out of its file.
MotionHistory HistoryOf(const std::vector<FrameMotions>& frames,
                        std::size_t memory = 1 << 20);

/// Changes the frames of a history, of which the indices stay.
void EditFrames(const std::function<void(FrameMotions&)>& edit,
                MotionHistory* history);

/// Changes frame i alone.
void EditFrame(int i, const std::function<void(FrameMotions&)>& edit,
               MotionHistory* history);

/// Frames [begin, end) of a history, by their order.
MotionHistory Frames(const MotionHistory& history, int begin, int end);

/// Joins models that have a history; see lib/model/surface_model.h.
SurfaceModel JoinModels(const std::vector<SurfaceModel>& models);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_MOTION_FRAMES_H_
