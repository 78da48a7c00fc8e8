#ifndef SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_
#define SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_

#include <optional>
#include <vector>

#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/energy/term_state.h"
#include "splitfusion/lib/render/model_rendering.h"

namespace splitfusion {

/// What the terms of one surface may see in one frame, put together from where
/// it is kept; refers to all that it is made from.
class SurfaceContext {
 public:
  /// `background`: the surface 0, in the live frame unless it is `surface`
  /// itself. `goes_on`: the surface is looked for where it was.
  SurfaceContext(const FrameFacts& frame, const Surface& surface,
                 const Surface& background, bool goes_on);
  SurfaceContext(const SurfaceContext&) = delete;             ///< Not copied.
  SurfaceContext& operator=(const SurfaceContext&) = delete;  ///< Not copied.

  /// Adds the model in the live view, in the one of the two that has it.
  void SetRendered(const MeshRendering& rendering, const ModelMap& background);

  /// Has the terms prepare what they keep of the surface, and adds it.
  /// `background`: what they keep of the background.
  void PrepareTerms(const SurfaceEnergies& energies, const LiveView& live,
                    const std::vector<TrackedPoint>& tracks,
                    const TermStates& background, TermStates* states);

  /// For the terms; holds as long as this.
  const TermContext& view() const { return view_; }

 private:
  const Surface& surface_;
  SurfaceFacts facts_;
  std::optional<SurfaceHistory> history_;
  RenderedModel rendered_;
  TermContext view_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_
