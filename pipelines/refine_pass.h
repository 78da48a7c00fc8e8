#ifndef SPLITFUSION_PIPELINES_REFINE_PASS_H_
#define SPLITFUSION_PIPELINES_REFINE_PASS_H_

#include <functional>
#include <map>

#include "splitfusion/lib/energy/frozen_problem.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/lib/report/refinement_report.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// What is kept of every surface, with the motions as they were tracked.
SurfaceModels ModelsOf(const SplitFusion& fusion);

/// The problem of a window as one that sf_solve takes: with the terms of
/// cost_functions/hidden_motion.h, weighted so that its energy is that of
/// RefineHiddenMotions() divided by the number of its edges (1 if it has none)
/// and s^2, s = 1 cm.
FrozenProblem FreezeWindow(const WindowProblem& window, int surface,
                           double smoothness);

/// Finds the hidden motions of a surface, RefineHiddenMotions(), and their
/// deviations, and adds them to a report. Returns how many nodes were hidden,
/// each frame counted. `world_from_camera`: by frame index. `solved`: as
/// RefineHiddenMotions().
int RefineAndReport(const std::map<int, Rigid3d>& world_from_camera,
                    const HiddenMotionOptions& options, int surface,
                    SurfaceModel* model, RefinementReport* report,
                    const std::function<void(const WindowProblem&)>& solved);

/// A pass over all frames, once they are tracked: finds the motions of what was
/// hidden, see RefineHiddenMotions(), of all surfaces but a background that is
/// ray cast, whose motion was measured in every frame. `shown`: called with the
/// number of surfaces so far and of all.
///
/// `models`: ModelsOf(fusion).
RefinementReport RefineModelMotions(const SplitFusion& fusion,
                                    const std::function<void(int, int)>& shown,
                                    SurfaceModels* models);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_REFINE_PASS_H_
