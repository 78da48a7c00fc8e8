#ifndef SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_
#define SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_

#include <optional>

#include "splitfusion/lib/energy/surface_history.h"
#include "splitfusion/lib/energy/term_context.h"
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

  /// The surface is in these images.
  void SetRendered(const MeshRendering& rendering);
  /// As the other, of a background that is ray cast.
  void SetRendered(const ModelMap& map);

  /// For the terms; holds as long as this.
  TermContext View() const;

 private:
  const FrameFacts& frame_;
  SurfaceFacts surface_;
  std::optional<SurfaceHistory> history_;
  RenderedModel rendered_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_SURFACE_CONTEXT_H_
