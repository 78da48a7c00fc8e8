#include "splitfusion/lib/model/unconfirmed_nodes.h"

#include <cstdint>

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/model/refuted_parts.h"

namespace splitfusion {

void UnconfirmedNodes::Look(const LiveView& live, int surface,
                            const std::vector<Eigen::Vector3f>& places,
                            const std::vector<char>& shown,
                            const std::vector<char>& facing,
                            double truncation) {
  const DepthTolerance<float> tolerance{static_cast<float>(truncation)};
  counts_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (shown[i] != 0) {
      ++counts_[i].seen;
      counts_[i].hidden = 0;
      continue;
    }
    const DepthState state = LookAt(live, surface, places[i], tolerance);
    if (state != DepthState::kObserved && state != DepthState::kOccluded) {
      continue;
    }
    const auto pixel = live.camera.PixelOf(places[i]);
    if (live.labels(pixel->y(), pixel->x()) != surface) continue;
    ++counts_[i].hidden;
    counts_[i].facing += static_cast<int>(facing[i] != 0);
  }
}

std::vector<char> UnconfirmedNodes::Confirmed(int sights) const {
  std::vector<char> nodes(counts_.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = sights > 0 && counts_[i].seen >= sights;
  }
  return nodes;
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
