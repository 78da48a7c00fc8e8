#include "splitfusion/lib/model/unconfirmed_nodes.h"

#include <cstdint>

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/model/refuted_parts.h"

namespace splitfusion {

void UnconfirmedNodes::Look(const LiveView& live, int surface,
                            const std::vector<Eigen::Vector3f>& places,
                            const std::vector<char>& facing,
                            double truncation) {
  const DepthTolerance<float> tolerance{static_cast<float>(truncation)};
  counts_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const DepthState state = LookAt(live, surface, places[i], tolerance);
    if (state == DepthState::kObserved) {
      ++counts_[i].seen;
      counts_[i].hidden = counts_[i].facing = 0;
    } else if (state == DepthState::kOccluded) {
      const auto pixel = live.camera.PixelOf(places[i]);
      if (live.labels(pixel->y(), pixel->x()) != surface) continue;
      ++counts_[i].hidden;
      counts_[i].facing += static_cast<int>(facing[i] != 0);
    }
  }
}

std::vector<char> UnconfirmedNodes::Nodes(int sights, int hidden) const {
  std::vector<char> nodes(counts_.size());
  if (sights == 0) return nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [seen, unseen, facing] = counts_[i];
    nodes[i] = seen < sights ? unseen >= hidden
                             : std::int64_t{facing} * sights >=
                                   std::int64_t{hidden} * seen;
  }
  return nodes;
}

void UnconfirmedNodes::Forget(const std::vector<char>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] != 0) counts_[i] = {};
  }
}

}  // namespace splitfusion
