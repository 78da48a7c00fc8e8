#include "support/motion_frames.h"

#include <utility>

namespace splitfusion {

std::vector<FrameMotions> FramesOf(const MotionHistory& history) {
  std::vector<FrameMotions> frames;
  for (const FrameMotions& frame : history) frames.push_back(frame);
  return frames;
}

MotionHistory HistoryOf(const std::vector<FrameMotions>& frames,
                        std::size_t memory) {
  MotionHistory history(memory);
  for (const FrameMotions& frame : frames) history.Append(frame);
  return history;
}

void EditFrames(const std::function<void(FrameMotions&)>& edit,
                MotionHistory* history) {
  for (int i = 0; i < history->size(); ++i) EditFrame(i, edit, history);
}

void EditFrame(int i, const std::function<void(FrameMotions&)>& edit,
               MotionHistory* history) {
  FrameMotions frame = history->At(i);
  edit(frame);
  history->Replace(std::move(frame));
}

MotionHistory Frames(const MotionHistory& history, int begin, int end) {
  const std::vector<FrameMotions> all = FramesOf(history);
  return HistoryOf({all.begin() + begin, all.begin() + end});
}

SurfaceModel JoinModels(const std::vector<SurfaceModel>& models) {
  std::vector<TrackedModel> tracked;
  for (const SurfaceModel& model : models) {
    TrackedModel one{model.mesh, model.graph, MotionLog()};
    for (const FrameMotions& frame : model.history) one.history.Append(frame);
    tracked.push_back(std::move(one));
  }
  return JoinModels(std::move(tracked));
}

}  // namespace splitfusion
