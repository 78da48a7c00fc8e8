#include "splitfusion/lib/energy/surface_history.h"

namespace splitfusion {
namespace {

/// A graph at the motions of a frame; its edges are left out.
DeformationGraph GraphAt(const SurfaceHistory::Past& past,
                         const FrameMotions& frame) {
  DeformationGraph graph;
  graph.positions = past.graph.positions;
  graph.motions = frame.motions;
  graph.node_spacing = past.graph.node_spacing;
  return graph;
}

}  // namespace

SurfaceHistory::SurfaceHistory(const Past& surface,
                               const std::optional<Past>& room)
    : surface_(surface) {
  if (room) room_.emplace(*room);
}

SurfaceHistory SurfaceHistory::InRigidRounds(
    const DeformationGraph& start) const {
  SurfaceHistory history(surface_, room_);
  history.rigid_start_ = &start;
  return history;
}

const FrameMotions* SurfaceHistory::Find(int back) const {
  if (back < 1 || back > size()) return nullptr;
  const FrameMotions& frame = surface_.motions.frames[size() - back];
  return frame.motions.size() == surface_.graph.positions.size() ? &frame
                                                                 : nullptr;
}

std::vector<NodeMotion> SurfaceHistory::Before(int back) const {
  const FrameMotions* frame = Find(back);
  if (frame == nullptr) return {};
  const std::optional<Rigid3d> live_from_camera = LiveFromCamera(frame->frame);
  if (!live_from_camera) return {};
  DeformationGraph graph = GraphAt(surface_, *frame);
  ApplyRigidMotion(*live_from_camera, &graph);
  if (rigid_start_ == nullptr) return graph.motions;
  return MakeRigidGraph(MeanRigidMotion(graph) *
                        MeanRigidMotion(*rigid_start_).inverse())
      .motions;
}

std::optional<Rigid3d> SurfaceHistory::LiveFromCamera(int frame) const {
  if (!room_) return Rigid3d::Identity();
  const FrameMotions* then = room_->motions.Find(frame);
  if (then == nullptr) return std::nullopt;
  return MeanRigidMotion(room_->graph) *
         MeanRigidMotion(GraphAt(*room_, *then)).inverse();
}

}  // namespace splitfusion
