#include "splitfusion/pipelines/surface_context.h"

namespace splitfusion {

SurfaceContext::SurfaceContext(const FrameFacts& frame, const Surface& surface,
                               const Surface& background, bool goes_on)
    : frame_(frame), surface_{surface.label(),          surface.kind(),
                              surface.first_frame(),    &surface.mesh(),
                              &surface.mesh_skinning(), &surface.volume()} {
  if (!goes_on) return;
  std::optional<SurfaceHistory::Past> room;
  if (!surface.is_background()) {
    room.emplace(
        SurfaceHistory::Past{background.graph(), background.history()});
  }
  history_.emplace(SurfaceHistory::Past{surface.graph(), surface.history()},
                   room);
}

void SurfaceContext::SetRendered(const MeshRendering& rendering) {
  rendered_ = {rendering.camera, &rendering.raster.depth, nullptr,
               &rendering.normals, nullptr};
}

void SurfaceContext::SetRendered(const ModelMap& map) {
  rendered_ = {map.camera, nullptr, &map.points, &map.normals, &map.color};
}

TermContext SurfaceContext::View() const {
  TermContext view;
  view.frame = &frame_;
  view.surface = &surface_;
  view.history = history_ ? &*history_ : nullptr;
  view.rendered = &rendered_;
  return view;
}

}  // namespace splitfusion
