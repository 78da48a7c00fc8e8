#ifndef SPLITFUSION_LIB_ENERGY_SURFACE_HISTORY_H_
#define SPLITFUSION_LIB_ENERGY_SURFACE_HISTORY_H_

#include <optional>
#include <vector>

#include "splitfusion/lib/deformation/motion_log.h"

namespace splitfusion {

/// Where a surface was in the frames before the one in which it is tracked. New
/// nodes have motions in frames before their first one, too: those that the
/// others blended to at their place; nodes that were forgotten are in none.
///
/// Refers to graphs and motions, which must outlive it; nothing is computed
/// before it is asked for.
class SurfaceHistory {
 public:
  /// The motions of a graph's nodes in the frames before, each in the camera of
  /// its frame.
  struct Past {
    const DeformationGraph& graph;  ///< As it is now.
    const MotionLog& motions;       ///< As many a frame as the graph has nodes.
  };

  /// `room`: the background, in the live frame already, which tells how the
  /// camera moved; none for the background itself.
  explicit SurfaceHistory(const Past& surface,
                          const std::optional<Past>& room = {});

  /// The same for rigid rounds, in which one node carries the whole surface
  /// from where it is in `start`, which must outlive it, too.
  SurfaceHistory InRigidRounds(const DeformationGraph& start) const;

  /// Number of frames that are known.
  int size() const { return surface_.motions.size(); }

  /// The frame `back` before the live one that is known, from 1 on: its index,
  /// whether the surface was tracked in it, and the motions of the nodes of the
  /// surface's graph in the camera of that frame, which is read from a file if
  /// it is long ago. None if there is none.
  std::optional<FrameMotions> Find(int back) const;

  /// Where it was then as the live camera would see it, as
  /// EnergyInput::before: one motion a node of EnergyInput::graph, metres. Of
  /// the background, had the camera stood still. Empty if it is not known.
  std::vector<NodeMotion> Before(int back) const;

 private:
  std::optional<Rigid3d> LiveFromCamera(int frame) const;

  Past surface_;
  std::optional<Past> room_;
  const DeformationGraph* rigid_start_ = nullptr;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SURFACE_HISTORY_H_
