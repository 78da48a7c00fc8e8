#ifndef SPLITFUSION_LIB_MODEL_HIDDEN_WINDOW_H_
#define SPLITFUSION_LIB_MODEL_HIDDEN_WINDOW_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "splitfusion/lib/base/normal_noise.h"
#include "splitfusion/lib/model/hidden_motions.h"
#include "splitfusion/lib/model/part_motions.h"

namespace splitfusion {

/// Noise that is added to the residuals of RefineHiddenMotions().
struct ResidualNoise {
  double arap = 0;         ///< Deviation of each number, metres; 0: none.
  double smoothness = 0;   ///< Likewise, with the weight of the term.
  std::uint64_t seed = 0;  ///< Same seed, same noise.

  /// Of edge (i, j) in a frame.
  Eigen::Vector3d OfEdge(int frame, int i, int j) const {
    if (arap == 0) return Eigen::Vector3d::Zero();
    return arap * NormalNoise(seed, frame, i, j);
  }
  /// Of the second difference of node i in time.
  Eigen::Vector3d OfDifference(int frame, int i) const {
    if (smoothness == 0) return Eigen::Vector3d::Zero();
    return smoothness * NormalNoise(seed, frame, i, -1);
  }
};

/// As large as the residuals of both terms are where everything that one
/// depends on was seen, root mean square of a number; 0 where nothing was.
ResidualNoise NoiseOfSeen(double smoothness, const PartMotions& motions);

/// What is told of the windows of a part, each of frames [begin, end).
struct WindowHooks {
  /// One will be looked at; asks for states of no others before it ends.
  std::function<void(int begin, int end)> begins;
  /// What was sought in these is found: no later window seeks it again.
  std::function<void(int begin, int end)> found;
  /// One was solved.
  std::function<void(const WindowProblem&)> solved;
};

/// Finds the hidden motions of a part, a window of frames after the other, as
/// RefineHiddenMotions() says, of residuals to which `noise` is added. Windows
/// in which nothing is hidden are left out.
std::vector<RefinedWindow> RefinePart(const HiddenMotionOptions& options,
                                      const ResidualNoise& noise,
                                      PartMotions* motions,
                                      const WindowHooks& hooks = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_HIDDEN_WINDOW_H_
