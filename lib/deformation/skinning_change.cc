#include "splitfusion/lib/deformation/skinning_change.h"

#include <limits>

#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {

SkinningChange::SkinningChange(const SkinningIndex& before,
                               const SkinningIndex& after,
                               const DeformationGraph& graph,
                               const NodeChange& nodes)
    : numbers_(nodes.Numbers()),
      renumbers_(nodes.forgotten() > 0),
      new_node_(nodes.before, std::numeric_limits<float>::infinity()) {
  std::vector<Eigen::Vector3f> added;
  for (std::size_t i = nodes.kept.size(); i < graph.positions.size(); ++i) {
    added.push_back(graph.positions[i].cast<float>());
  }
  if (!added.empty()) {
    const NearestPoint tree(added);
    for (const int i : nodes.kept) {
      tree.Find(graph.positions[numbers_[i]].cast<float>(), -1, &new_node_[i]);
    }
  }
  for (int i = 0; i < nodes.before; ++i) {
    first_difference_.push_back(
        SkinningIndex::FirstDifference(before, after, numbers_, i));
  }
}

void SkinningChange::Renumber(Skinning* skinning,
                              SkinningSupport* support) const {
  if (!renumbers_) return;
  support->nearest = numbers_[support->nearest];
  for (int k = 0; k < skinning->count; ++k) {
    skinning->nodes[k] = numbers_[skinning->nodes[k]];
  }
}

}  // namespace splitfusion
