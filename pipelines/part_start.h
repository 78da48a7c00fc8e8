#ifndef SPLITFUSION_PIPELINES_PART_START_H_
#define SPLITFUSION_PIPELINES_PART_START_H_

#include <functional>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/pipelines/part_start_options.h"

namespace splitfusion {

/// Parts that were moved before a surface deforms.
struct PartStart {
  int parts = 0;              ///< Their number.
  std::vector<char> carried;  ///< By node, whether a part carries it.
};

/// Moves parts of a deforming surface near to where they are, before it is
/// deformed: limbs that move farther between frames than correspondences reach
/// are left behind else, as what they would be paired with is another limb.
///
/// Points that were matched between the images (FrameMatcher) and moved
/// otherwise than the surface so far are searched for rigid parts
/// (FindRigidParts). What is nearest to the points of a part is carried by its
/// motion, if it fits better there; what is near to none stays. Where parts
/// meet, the surface bends as rigidly as it can. Not in the paper.
class PartStarter {
 public:
  /// Misfit of samples of the surface under a graph's motions, as the tracker
  /// judges starts.
  using Misfit = std::function<double(const std::vector<ModelSample>& samples,
                                      const DeformationGraph& graph)>;

  /// A surface and what is known of it.
  struct Surface {
    const std::vector<ModelSample>& samples;  ///< In view.
    /// In the live camera frame, `from` where the point would be had the
    /// surface stood still in the world.
    const std::vector<PointMotion>& motions;
    const PinholeCamera& camera;     ///< Live.
    const DeformationGraph& stayed;  ///< Where it was, likewise.
    const Misfit& misfit;            ///< Of it.
  };

  /// `options`: as checked. `solver`: outlives this.
  PartStarter(PartStartOptions options, const Solver& solver);

  /// Moves parts of a graph, which is where its surface is before it deforms.
  /// Unchanged if the result has none.
  PartStart Start(const Surface& surface, DeformationGraph* graph) const;

 private:
  /// Labels what parts do not fit that carry it as what stays; the number of
  /// parts that do.
  int KeepWhatFits(const Surface& surface, const std::vector<RigidPart>& parts,
                   const DeformationGraph& graph,
                   std::vector<int>* labels) const;

  PartStartOptions options_;
  const Solver& solver_;
  Energy energy_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_PART_START_H_
