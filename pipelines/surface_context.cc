#include "splitfusion/pipelines/surface_context.h"

#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

SurfaceContext::SurfaceContext(const FrameFacts& frame, const Surface& surface,
                               const Surface& background, bool goes_on)
    : surface_(surface), facts_{surface.label(),          surface.kind(),
                                surface.first_frame(),    &surface.mesh(),
                                &surface.mesh_skinning(), &surface.volume()} {
  view_.frame = &frame;
  view_.surface = &facts_;
  view_.surface_graph = &surface.graph();
  if (!goes_on) return;
  std::optional<SurfaceHistory::Past> room;
  if (!surface.is_background()) {
    room.emplace(
        SurfaceHistory::Past{background.graph(), background.history()});
  }
  history_.emplace(SurfaceHistory::Past{surface.graph(), surface.history()},
                   room);
  view_.history = &*history_;
}

void SurfaceContext::SetRendered(const MeshRendering& rendering,
                                 const ModelMap& background) {
  if (surface_.is_ray_cast()) {
    rendered_ = {background.camera, nullptr, &background.points,
                 &background.normals, &background.color};
  } else {
    rendered_ = {rendering.camera, &rendering.raster.depth, nullptr,
                 &rendering.normals, nullptr};
  }
  view_.rendered = &rendered_;
}

void SurfaceContext::PrepareTerms(const SurfaceEnergies& energies,
                                  const LiveView& live,
                                  const std::vector<TrackedPoint>& tracks,
                                  const TermStates& background,
                                  TermStates* states) {
  const std::vector<Correspondence> none;
  EnergyInput input{surface_.graph(), none, live.camera, &live};
  input.tracks = &tracks;
  input.surface = surface_.id();
  input.context = view_;
  const Energy& energy = energies.Of(surface_.label());
  states->BeginUnknowns(energy, background);
  states->Prepare(energy, input);
  view_.states = states;
}

}  // namespace splitfusion
