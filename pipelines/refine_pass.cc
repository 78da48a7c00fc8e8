#include "splitfusion/pipelines/refine_pass.h"

#include <vector>

#include "splitfusion/lib/model/hidden_deviations.h"

namespace splitfusion {

SurfaceModels ModelsOf(const SplitFusion& fusion) {
  SurfaceModels models;
  for (const auto& [id, surface] : fusion.surfaces()) {
    models[id] = surface->Model();
  }
  return models;
}

int RefineAndReport(const std::map<int, Rigid3d>& world_from_camera,
                    const HiddenMotionOptions& options, int surface,
                    SurfaceModel* model, RefinementReport* report) {
  const std::vector<RefinedWindow> windows =
      RefineHiddenMotions(world_from_camera, options, model);
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
      RefineAndReport(poses, fusion.options().hidden, id, &model, &report);
    }
    shown(++done, static_cast<int>(models->size()));
  }
  return report;
}

}  // namespace splitfusion
