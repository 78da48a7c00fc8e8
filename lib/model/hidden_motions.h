#ifndef SPLITFUSION_LIB_MODEL_HIDDEN_MOTIONS_H_
#define SPLITFUSION_LIB_MODEL_HIDDEN_MOTIONS_H_

#include <functional>
#include <map>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/links_in_time.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// How motions are looked for where nothing was seen.
struct HiddenMotionOptions {
  bool refine = true;  ///< Once all frames are known.
  /// Weight of smoothness in time, of that of Eq. 6.
  double smoothness = 100;
  /// Frames of which the motions are found together; half of them are kept, and
  /// the others found anew with those that follow.
  int window = 32;
  /// Samples of HiddenDeviations(); 0: none.
  int samples = 0;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// The two terms that say where hidden nodes are, square metres.
struct HiddenMotionCost {
  double arap = 0;        ///< Sum of |r|^2, Eq. 6.
  double smoothness = 0;  ///< Weighted sum of |r|^2.
};

/// One window of one part of a surface.
struct RefinedWindow {
  int part = 0;         ///< Index among DeformationGraph::parts.
  int first_frame = 0;  ///< Index.
  int last_frame = 0;   ///< Index.
  int hidden = 0;       ///< Unknowns: hidden nodes, each frame counted.
  /// Of these what the next window does not seek again.
  int kept = 0;
  int iterations = 0;        ///< Of places and rotations, in turn.
  bool solved = true;        ///< False: the motions are as they were.
  HiddenMotionCost initial;  ///< Where it began.
  HiddenMotionCost final;    ///< Where it ended.
};

/// What is solved of a window, for other solvers.
struct WindowProblem {
  DeformationGraph graph;  ///< As LinksInTime says; where it starts.
  LinksInTime links;       ///< Edges and differences in time.
  RefinedWindow report;    ///< How it was solved.
};

/// Finds the motions of nodes in the frames in which they were not seen
/// (FrameMotions::seen), between their first and their last sight; of the other
/// nodes too in frames in which nothing of their part of the surface was seen,
/// between the first and the last in which anything was. All else stays as it
/// was tracked, and so do parts that were refuted
/// (WhichWereRefuted()): they are pieces, of which nothing but
/// what tracking tied them to says where they were. A frame alone has no more
/// than its neighbours on the surface to say where a hidden node is; the whole
/// sequence has its last and its next sight. Minimised is
///
///   E = sum |c_i - c_j - R_i (g_i - g_j)|^2
///       + mu sum |w(t-1) - 2 w(t) + w(t+1)|^2
///
/// over all edges (Eq. 6) and nodes, in all frames; c: centres of nodes in the
/// camera frame, w: the same in the world, mu: options.smoothness. Places and
/// rotations are found in turn (Sorkine and Alexa 2007), the places by one
/// sparse factorisation (CHOLMOD). Frames that are left out count by the time
/// between them. Not in the paper; Dou et al. 2015 and Li et al. 2020 optimise
/// over whole sequences.
///
/// `world_from_camera`: by frame index, of all frames of the history. The one
/// node of a rigid surface counts as if it were amid its mesh. `solved`: is
/// shown what was solved, window by window.
/// Of the frames those of one window are in memory at a time.
///
/// @return by part, then in time; none where nothing is hidden. Does not depend
///     on the number of threads.
/// @throw InputError if temporary files cannot be read or written.
std::vector<RefinedWindow> RefineHiddenMotions(
    const std::map<int, Rigid3d>& world_from_camera,
    const HiddenMotionOptions& options, SurfaceModel* model,
    const std::function<void(const WindowProblem&)>& solved = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_HIDDEN_MOTIONS_H_
