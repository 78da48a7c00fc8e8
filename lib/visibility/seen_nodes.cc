#include "splitfusion/lib/visibility/seen_nodes.h"

#include <algorithm>

namespace splitfusion {

std::vector<double> SeenShares(
    const std::vector<Correspondence>& correspondences, int nodes) {
  std::vector<double> shares(nodes, 0.0);
  for (const Correspondence& c : correspondences) {
    const Skinning& skinning = c.model.skinning;
    for (int k = 0; k < skinning.count; ++k) {
      shares[skinning.nodes[k]] += skinning.weights[k] / kSeenPoints;
    }
  }
  for (double& share : shares) share = std::min(1.0, share);
  return shares;
}

}  // namespace splitfusion
