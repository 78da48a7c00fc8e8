#ifndef SPLITFUSION_LIB_MODEL_REFUTED_PARTS_H_
#define SPLITFUSION_LIB_MODEL_REFUTED_PARTS_H_

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "splitfusion/lib/deformation/node_change.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {

/// What the live pixel of a point (camera frame, metres) says about it, depths
/// within `tolerance` being equal: nothing at depth edges, beside other
/// surfaces and outside of the image; of the pixels of its surface alone that
/// it is there.
DepthState LookAt(const LiveView& live, int surface,
                  const Eigen::Vector3f& point,
                  const DepthTolerance<float>& tolerance);

/// Counts for every node of a deforming surface the frames on end in which live
/// depth refutes what it carries: most of it hangs in free space, since depth
/// is measured behind it. A limb that moved while it was hidden, or by more
/// than tracking follows, is such a part: it is where nothing is, and no
/// correspondence brings it back.
class RefutedParts {
 public:
  /// Looks at one frame. `warped`: the mesh's vertices in the camera frame,
  /// metres; `skinning`: theirs, by `nodes` nodes; `truncation`: of the
  /// surface's volume, metres. What is hidden, or near no depth, says nothing.
  void Look(const LiveView& live, int surface,
            const std::vector<Eigen::Vector3f>& warped,
            const std::vector<Skinning>& skinning, int nodes,
            double truncation);

  /// Of every node whether it has been refuted in at least so many frames on
  /// end, and in less than `end`.
  std::vector<char> Nodes(int frames,
                          int end = std::numeric_limits<int>::max()) const;

  /// Begins to count anew for these nodes: what they carried is gone.
  void Forget(const std::vector<char>& nodes);

  /// Follows the nodes of the graph.
  void Follow(const NodeChange& change) {
    change.Apply(&frames_);
    frames_.resize(change.kept.size() + change.added, 0);
  }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frames_);
  }

 private:
  std::vector<int> frames_;  // On end, by node.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_REFUTED_PARTS_H_
