#ifndef SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_
#define SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_

#include <vector>

#include "splitfusion/lib/deformation/skinning.h"

namespace splitfusion {

/// Where the growth of a graph changed the skinning of points: most of a
/// surface is far from its few new nodes and keeps what it has.
class SkinningChange {
 public:
  /// `graph`: the one of `after`, of which `before` has the first nodes.
  SkinningChange(const SkinningIndex& before, const SkinningIndex& after,
                 const DeformationGraph& graph);

  /// Whether a point's skinning by the index before is the one by the index
  /// after, bit for bit. May be false though it is.
  bool Keeps(const SkinningSupport& support) const {
    return support.nearest >= 0 &&
           2.001f * support.distance < new_node_[support.nearest] &&  // Maths.
           support.reach < first_difference_[support.nearest];
  }

 private:
  // Per node of the index before, metres: the distance of the nearest new node
  // and of the first difference between its candidates.
  std::vector<float> new_node_;
  std::vector<float> first_difference_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_
