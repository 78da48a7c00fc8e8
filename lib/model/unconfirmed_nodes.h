#ifndef SPLITFUSION_LIB_MODEL_UNCONFIRMED_NODES_H_
#define SPLITFUSION_LIB_MODEL_UNCONFIRMED_NODES_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/deformation/node_change.h"
#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// Counts for every node of a deforming surface the frames in which it was seen
/// and those since then in which the surface itself hid it. Where tracking
/// loses a limb, live points of it are fused wherever the warp field happens to
/// carry them back, and a few frames later somewhere else: such pieces come to
/// lie inside of the body, where no depth will ever refute them, and pull at
/// what is tracked. They were seen in few frames. Point-based fusion drops
/// points that were not confirmed in time likewise (Keller et al. 2013,
/// section 4.4). A model that was followed for a while before it was lost is
/// believed for longer, but not for ever.
class UnconfirmedNodes {
 public:
  /// Looks at one frame. `places`: of the nodes in the camera frame, metres;
  /// `shown`: of every one whether live points were found to be at what it
  /// carries (CanonicalPlaces): it is seen. `facing`: whether that faces the
  /// camera (NodesFacing()); `truncation`: of the surface's volume, metres. A
  /// node that is not shown is hidden by the surface where a live pixel of the
  /// surface lies before it or within the truncation. What something else hides,
  /// or what is outside of the image, says nothing.
  void Look(const LiveView& live, int surface,
            const std::vector<Eigen::Vector3f>& places,
            const std::vector<char>& shown, const std::vector<char>& facing,
            double truncation);

  /// Of every node whether it was seen in `sights` frames: it is confirmed.
  /// None if `sights` is 0.
  std::vector<char> Confirmed(int sights) const;

  /// Of every node whether it is to be forgotten. One that was seen in less
  /// than `sights` frames: if the surface itself has hidden it, since it was
  /// seen last, in `hidden` frames. One that was seen in n times `sights`: if
  /// the surface has hidden it in n times `hidden` of all frames in which it
  /// faced the camera; one's back is hidden as long as one is seen from the
  /// front. None if `sights` is 0.
  std::vector<char> Nodes(int sights, int hidden) const;

  /// Begins to count anew for these nodes: what they carried is gone.
  void Forget(const std::vector<char>& nodes);

  /// Follows the nodes of the graph.
  void Follow(const NodeChange& change) {
    change.Apply(&counts_);
    counts_.resize(change.kept.size() + change.added);
  }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(counts_);
  }

 private:
  /// Of a node, frames.
  struct Counts {
    int seen = 0;    ///< In which it was.
    int hidden = 0;  ///< In which the surface hid it, since it was seen last.
    int facing = 0;  ///< In which it did although it faced the camera.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(seen, hidden, facing);
    }
  };

  std::vector<Counts> counts_;  // By node.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_UNCONFIRMED_NODES_H_
