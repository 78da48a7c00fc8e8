#ifndef SPLITFUSION_PIPELINES_REFINE_PASS_H_
#define SPLITFUSION_PIPELINES_REFINE_PASS_H_

#include <functional>
#include <string>

#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// What is kept of every surface, with the motions as they were tracked.
SurfaceModels ModelsOf(const SplitFusion& fusion);

/// A pass over all frames, once they are tracked: finds the motions of what was
/// hidden, see RefineHiddenMotions(), of all surfaces but a background that is
/// ray cast, whose motion was measured in every frame. `shown`: called with the
/// number of surfaces so far and of all.
///
/// `models`: ModelsOf(fusion).
/// @return the lines of refinement.jsonl.
std::string RefineModelMotions(const SplitFusion& fusion,
                               const std::function<void(int, int)>& shown,
                               SurfaceModels* models);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_REFINE_PASS_H_
