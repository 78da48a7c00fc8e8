#include "splitfusion/lib/model/unconfirmed_nodes.h"

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/model/refuted_parts.h"

namespace splitfusion {

void UnconfirmedNodes::Look(const LiveView& live, int surface,
                            const std::vector<Eigen::Vector3f>& places,
                            double truncation) {
  const DepthTolerance<float> tolerance{static_cast<float>(truncation)};
  counts_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const DepthState state = LookAt(live, surface, places[i], tolerance);
    if (state == DepthState::kObserved) {
      ++counts_[i].seen;
      counts_[i].hidden = 0;
    } else if (state == DepthState::kOccluded) {
      const auto pixel = live.camera.PixelOf(places[i]);
      if (live.labels(pixel->y(), pixel->x()) == surface) ++counts_[i].hidden;
    }
  }
}

std::vector<char> UnconfirmedNodes::Nodes(int sights, int hidden) const {
  std::vector<char> nodes(counts_.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = counts_[i].seen < sights && counts_[i].hidden >= hidden;
  }
  return nodes;
}

void UnconfirmedNodes::Forget(const std::vector<char>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] != 0) counts_[i] = {};
  }
}

}  // namespace splitfusion
