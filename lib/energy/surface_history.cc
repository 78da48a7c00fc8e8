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

std::optional<FrameMotions> SurfaceHistory::Find(int back) const {
  if (back < 1 || back > size()) return std::nullopt;
  FrameMotions frame = surface_.motions.At(size() - back);
  if (frame.motions.size() != surface_.graph.positions.size()) {
    return std::nullopt;
  }
  return frame;
}

std::vector<NodeMotion> SurfaceHistory::Before(int back) const {
  const std::optional<FrameMotions> frame = Find(back);
  if (!frame) return {};
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
  const std::optional<FrameMotions> then = room_->motions.Find(frame);
  if (!then) return std::nullopt;
  return MeanRigidMotion(room_->graph) *
         MeanRigidMotion(GraphAt(*room_, *then)).inverse();
}

}  // namespace splitfusion
