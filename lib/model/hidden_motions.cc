#include "splitfusion/lib/model/hidden_motions.h"

#include <algorithm>
#include <map>
#include <vector>

#include "splitfusion/lib/model/hidden_window.h"
#include "splitfusion/lib/model/part_motions.h"

namespace splitfusion {

void HiddenMotionOptions::List(OptionList* list) {
  list->Switch("refine", &refine,
               "Once all frames are known, find the motions of what was hidden "
               "between its last and its next sight.");
  list->Number(
      "refine_smoothness", &smoothness, {0, 1e6, true}, "",
      "Weight of smoothness in time of what was hidden, of that of its "
      "shape.");
  list->Number("refine_window", &window, Range::AtLeast(4), "frames",
               "Frames of which the motions are found together.");
  list->Number("refine_samples", &samples, {0, 10000}, "",
               "Solutions under noise of the residuals' size, from which "
               "deviations of what was hidden are estimated; 0 = none.");
}

std::vector<RefinedWindow> RefineHiddenMotions(
    const std::map<int, Rigid3d>& world_from_camera,
    const HiddenMotionOptions& options, SurfaceModel* model,
    const std::function<void(const WindowProblem&)>& solved) {
  const std::size_t parts = std::max<std::size_t>(1, model->graph.parts.size());
  const std::vector<Eigen::Vector3d> centers = CentersOf(*model);
  std::vector<char> refuted = WhichWereRefuted(model->graph);
  refuted.resize(parts, false);
  std::vector<RefinedWindow> all;
  for (std::size_t part = 0; part < parts; ++part) {
    if (refuted[part] != 0) continue;
    const PartFrames frames(part, centers, world_from_camera, *model);
    PartMotions motions = frames.motions();
    WindowHooks hooks;
    hooks.begins = [&](int begin, int end) {
      frames.Load(begin, end, &motions);
    };
    hooks.found = [&](int begin, int end) {
      StoreMotions(motions, begin, end, world_from_camera, model);
    };
    hooks.solved = solved;
    const std::vector<RefinedWindow> windows =
        RefinePart(options, {}, &motions, hooks);
    all.insert(all.end(), windows.begin(), windows.end());
  }
  return all;
}

}  // namespace splitfusion
