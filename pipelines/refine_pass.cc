#include "splitfusion/pipelines/refine_pass.h"

#include <map>

#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/report/refinement_report.h"

namespace splitfusion {

SurfaceModels ModelsOf(const SplitFusion& fusion) {
  SurfaceModels models;
  for (const auto& [id, surface] : fusion.surfaces()) {
    models[id] = surface->Model();
  }
  return models;
}

std::string RefineModelMotions(const SplitFusion& fusion,
                               const std::function<void(int, int)>& shown,
                               SurfaceModels* models) {
  const std::map<int, Rigid3d> poses = fusion.PosesByFrame();
  std::string lines;
  int done = 0;
  for (auto& [id, model] : *models) {
    if (!fusion.surfaces().at(id)->is_ray_cast()) {
      lines += RefinementLines(
          id, RefineHiddenMotions(poses, fusion.options().hidden, &model));
    }
    shown(++done, static_cast<int>(models->size()));
  }
  return lines;
}

}  // namespace splitfusion
