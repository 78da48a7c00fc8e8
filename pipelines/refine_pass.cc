#include "splitfusion/pipelines/refine_pass.h"

#include <algorithm>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/number_text.h"
#include "splitfusion/lib/model/hidden_deviations.h"

namespace splitfusion {

SurfaceModels ModelsOf(const SplitFusion& fusion) {
  SurfaceModels models;
  for (const auto& [id, surface] : fusion.surfaces()) {
    models[id] = surface->Model();
  }
  return models;
}

FrozenProblem FreezeWindow(const WindowProblem& window, int surface,
                           double smoothness) {
  const auto edges = std::max<double>(1, window.links.edges.size());
  const auto triples = static_cast<double>(window.links.triples.size());
  const double unit = edges * kResidualUnit * kResidualUnit;
  FrozenProblem problem;
  problem.frame = window.report.first_frame;
  problem.surface = surface;
  // Each term is the mean of its residuals.
  problem.energy =
      ParseEnergy("hidden_arap(weight=1) hidden_smoothness(weight=" +
                      NumberText(smoothness * triples / edges) + ")",
                  BuiltinTerms());
  problem.camera = {1, 1, 1, 1, 0, 0};  // No term looks at it.
  problem.graph = window.graph;
  problem.links = window.links;
  problem.start = EvaluateStart(problem.View(), problem.graph);
  problem.solver = "places and rotations in turn";
  const HiddenMotionCost& final = window.report.final;
  problem.final_cost = (final.arap + final.smoothness) / unit;
  return problem;
}

int RefineAndReport(const std::map<int, Rigid3d>& world_from_camera,
                    const HiddenMotionOptions& options, int surface,
                    SurfaceModel* model, RefinementReport* report,
                    const std::function<void(const WindowProblem&)>& solved) {
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(world_from_camera, options, model, solved);
  report->Add(surface, windows,
              HiddenDeviations(world_from_camera, options, *model));
  int hidden = 0;
  for (const RefinedWindow& window : windows) hidden += window.kept;
  return hidden;
}

RefinementReport RefineModelMotions(const SplitFusion& fusion,
                                    const std::function<void(int, int)>& shown,
                                    SurfaceModels* models) {
  const std::map<int, Rigid3d> poses = fusion.PosesByFrame();
  RefinementReport report;
  int done = 0;
  for (auto& [id, model] : *models) {
    if (!fusion.surfaces().at(id)->is_ray_cast()) {
      RefineAndReport(poses, fusion.options().hidden, id, &model, &report,
                      /*solved=*/{});
    }
    shown(++done, static_cast<int>(models->size()));
  }
  return report;
}

}  // namespace splitfusion
