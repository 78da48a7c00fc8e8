#include "splitfusion/lib/deformation/node_births.h"

#include <map>
#include <utility>

#include "splitfusion/lib/base/chosen.h"

namespace splitfusion {

NodeBirths::NodeBirths(const DeformationGraph& graph,
                       const SkinningIndex& index,
                       std::vector<Eigen::Vector3f> places)
    : places_(std::move(places)) {
  std::map<int, int> number;
  for (const Eigen::Vector3f& g : places_) {
    Skinning skinning = index.Skin(g);
    for (int k = 0; k < skinning.count; ++k) {
      const int node = skinning.nodes[k];
      const auto [entry, is_new] =
          number.emplace(node, static_cast<int>(carriers_.size()));
      if (is_new) {
        carriers_.push_back(node);
        carrier_positions_.push_back(graph.positions[node]);
      }
      skinning.nodes[k] = entry->second;
    }
    skinning_.push_back(skinning);
  }
}

NodeBirths NodeBirths::Renumbered(const std::vector<int>& numbers) const {
  NodeBirths births = *this;
  for (int& node : births.carriers_) node = numbers[node];
  return births;
}

NodeBirths NodeBirths::Part(const std::vector<char>& nodes) const {
  NodeBirths part;
  part.places_ = Chosen(places_, nodes);
  part.skinning_ = Chosen(skinning_, nodes);
  std::vector<int> index(carriers_.size(), -1);
  for (Skinning& skinning : part.skinning_) {
    for (int k = 0; k < skinning.count; ++k) {
      const int carrier = skinning.nodes[k];
      if (index[carrier] < 0) {
        index[carrier] = static_cast<int>(part.carriers_.size());
        part.carriers_.push_back(carriers_[carrier]);
        part.carrier_positions_.push_back(carrier_positions_[carrier]);
      }
      skinning.nodes[k] = index[carrier];
    }
  }
  return part;
}

std::vector<NodeMotion> NodeBirths::Blended(
    const std::vector<NodeMotion>& motions) const {
  DeformationGraph carriers;
  carriers.positions = carrier_positions_;
  carriers.motions = motions;
  const WarpField warp(carriers);
  std::vector<NodeMotion> blended;
  blended.reserve(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) {
    blended.push_back(warp.BlendMotion(skinning_[i], places_[i]));
  }
  return blended;
}

void NodeBirths::Append(std::vector<NodeMotion>* motions) const {
  std::vector<NodeMotion> of_carriers;
  for (const int node : carriers_) of_carriers.push_back((*motions)[node]);
  const std::vector<NodeMotion> blended = Blended(of_carriers);
  // Histories of many frames grow so: not by twice what they need.
  motions->reserve(motions->size() + blended.size());
  motions->insert(motions->end(), blended.begin(), blended.end());
}

}  // namespace splitfusion
