#include "splitfusion/lib/model/hidden_motions.h"

#include <tbb/parallel_for.h>

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
    const HiddenMotionOptions& options, SurfaceModel* model) {
  const std::size_t parts = std::max<std::size_t>(1, model->graph.parts.size());
  const std::vector<Eigen::Vector3d> centers = CentersOf(*model);
  std::vector<std::vector<RefinedWindow>> windows(parts);
  std::vector<char> refuted = WhichWereRefuted(model->graph);
  refuted.resize(parts, false);
  tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t index) {
    if (refuted[index] != 0) return;
    PartMotions motions =
        MotionsOfPart(*model, index, centers, world_from_camera);
    windows[index] = RefinePart(options, {}, &motions);
    StoreMotions(motions, world_from_camera, model);
  });
  std::vector<RefinedWindow> all;
  for (std::size_t index = 0; index < parts; ++index) {
    for (RefinedWindow& window : windows[index]) {
      window.part = static_cast<int>(index);
      all.push_back(window);
    }
  }
  return all;
}

}  // namespace splitfusion
