#ifndef SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_
#define SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_

#include <vector>

#include "splitfusion/lib/deformation/node_change.h"
#include "splitfusion/lib/deformation/skinning.h"

namespace splitfusion {

/// Where a change of a graph changed the skinning of points: most of a surface
/// is far from the few nodes that came or went and keeps what it has, but for
/// the nodes' numbers.
class SkinningChange {
 public:
  /// `graph`: the one of `after`; `nodes`: what made it of that of `before`.
  SkinningChange(const SkinningIndex& before, const SkinningIndex& after,
                 const DeformationGraph& graph, const NodeChange& nodes);

  /// Whether a point's skinning by the index before is the one by the index
  /// after, bit for bit but for the nodes' numbers. May be false though it is.
  bool Keeps(const SkinningSupport& support) const {
    return support.nearest >= 0 &&
           2.001f * support.distance < new_node_[support.nearest] &&  // Maths.
           support.reach < first_difference_[support.nearest];
  }

  /// Whether the node of an index before is still there.
  bool KeepsNode(int node) const { return numbers_[node] >= 0; }

  /// Gives the nodes of a skinning that is kept the numbers that they have now.
  void Renumber(Skinning* skinning, SkinningSupport* support) const;

 private:
  std::vector<int> numbers_;  // NodeChange::Numbers().
  bool renumbers_;            // Some have changed.
  // Per node of the index before, metres: the distance of the nearest new node
  // and of the first difference between its candidates.
  std::vector<float> new_node_;
  std::vector<float> first_difference_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SKINNING_CHANGE_H_
