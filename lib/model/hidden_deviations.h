#ifndef SPLITFUSION_LIB_MODEL_HIDDEN_DEVIATIONS_H_
#define SPLITFUSION_LIB_MODEL_HIDDEN_DEVIATIONS_H_

#include <map>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// How well it is known where a node was while it was hidden.
struct HiddenDeviation {
  int node = 0;      ///< Index among the graph's.
  int frame = 0;     ///< Index.
  double sigma = 0;  ///< Of one coordinate of its centre, in the world, metres.
};

/// How far what RefineHiddenMotions() found may be from the truth, over time: a
/// least squares solution is off by what the residuals are at the truth,
/// propagated, x - x_true = -(J^T J)^-1 J^T r(x_true). So noise of their size
/// is added to all residuals and the same energy minimised, and that
/// options.samples times (randomize-then-optimize, Bardsley et al. 2014): a
/// deviation is the root mean square, over samples and axes, by which a node
/// comes to lie elsewhere than without noise. Their size is the root mean
/// square of each term where the nodes of the same part were seen
/// (NoiseOfSeen()). What was seen counts as known. Residuals of neighbours and
/// of successive frames are not independent, which the noise is: deviations are
/// to be multiplied by a fitted scale (docs/evaluation.md), and have a relative
/// error of their own of 1 / sqrt(6 samples).
///
/// `model`: as RefineHiddenMotions() left it with these options.
/// @return by part, then in time, then by node. Does not depend on the number
///     of threads.
std::vector<HiddenDeviation> HiddenDeviations(
    const std::map<int, Rigid3d>& world_from_camera,
    const HiddenMotionOptions& options, const SurfaceModel& model);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_HIDDEN_DEVIATIONS_H_
