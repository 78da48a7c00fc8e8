#include "splitfusion/lib/deformation/skinning_change.h"

#include <limits>

#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {

SkinningChange::SkinningChange(const SkinningIndex& before,
                               const SkinningIndex& after,
                               const DeformationGraph& graph) {
  std::vector<Eigen::Vector3f> added;
  for (int i = before.node_count(); i < after.node_count(); ++i) {
    added.push_back(graph.positions[i].cast<float>());
  }
  new_node_.assign(before.node_count(), std::numeric_limits<float>::infinity());
  if (!added.empty()) {
    const NearestPoint tree(added);
    for (int i = 0; i < before.node_count(); ++i) {
      tree.Find(graph.positions[i].cast<float>(), -1, &new_node_[i]);
    }
  }
  for (int i = 0; i < before.node_count(); ++i) {
    first_difference_.push_back(
        SkinningIndex::FirstDifference(before, after, i));
  }
}

}  // namespace splitfusion
