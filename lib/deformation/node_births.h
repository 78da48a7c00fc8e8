#ifndef SPLITFUSION_LIB_DEFORMATION_NODE_BIRTHS_H_
#define SPLITFUSION_LIB_DEFORMATION_NODE_BIRTHS_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/deformation/skinning.h"

namespace splitfusion {

/// New nodes of a graph: they move as the nodes that there were blend to at
/// their places (Eq. 2), in every frame before, too.
class NodeBirths {
 public:
  /// None.
  NodeBirths() = default;
  /// Of nodes at `places` (canonical frame, metres). `graph`, `index`: of the
  /// nodes that there were.
  NodeBirths(const DeformationGraph& graph, const SkinningIndex& index,
             std::vector<Eigen::Vector3f> places);

  /// Number of new nodes.
  int size() const { return static_cast<int>(places_.size()); }
  /// The nodes whose motions they are blended from.
  const std::vector<int>& carriers() const { return carriers_; }

  /// The same where node i has the number `numbers[i]`.
  NodeBirths Renumbered(const std::vector<int>& numbers) const;

  /// The new nodes whose entry of `nodes` (size()) is not 0, in their order,
  /// with the carriers that these are blended from.
  NodeBirths Part(const std::vector<char>& nodes) const;

  /// The motions of the new nodes in one frame, of those of carriers() in it.
  std::vector<NodeMotion> Blended(const std::vector<NodeMotion>& motions) const;

  /// Appends the motions of the new nodes to those of one frame.
  void Append(std::vector<NodeMotion>* motions) const;

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(places_, carriers_, carrier_positions_);
    skinning_.resize(places_.size());
    for (Skinning& one : skinning_) {
      (*archive)(one.nodes, one.weights, one.count);
    }
  }

 private:
  std::vector<Eigen::Vector3f> places_;
  std::vector<int> carriers_;
  std::vector<Eigen::Vector3d> carrier_positions_;
  std::vector<Skinning> skinning_;  // Of the places, by index of the carrier.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_NODE_BIRTHS_H_
